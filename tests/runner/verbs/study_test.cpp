// What `peclet study` reads and lists.
#include "runner/verbs/study.h"

#include <gtest/gtest.h>

#include <fstream>

#include "contract/input_error.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

class Studies : public testing::Test {
 protected:
  void add(const std::string& name, const std::string& found) {
    std::filesystem::create_directories(folder_.path() / name);
    std::ofstream(folder_.path() / name / "study.py") << "raise SystemExit(3)\n";
    if (!found.empty()) std::ofstream(folder_.path() / name / "study.json") << found;
  }
  TemporaryFolder folder_;
};

constexpr const char* found = R"({"title": "Diffusion", "verdict": "holds with a difference",
  "processor_hours": 0.25, "date": "2026-01-31", "engine": ["1234567"], "machine": "x",
  "statements": [{"kind": "statement", "answer": "holds"}, {"kind": "statement", "answer": "does not hold"},
                 {"kind": "statement", "answer": "holds"}, {"kind": "check", "answer": "ok"},
                 {"kind": "check", "answer": "failed"}, {"kind": "finding", "value": 1}]})";

TEST_F(Studies, AreListedInOrderWithWhatTheyFound) {
  add("zero-shear", "");
  add("diffusion", found);
  std::filesystem::create_directories(folder_.path() / "no-study");
  const std::vector<StudySummary> studies = read_studies(folder_.path());
  EXPECT_EQ(studies_table(studies),
            "study       verdict                  statements that hold  checks passed  CPU h        made\n"
            "diffusion   holds with a difference                2 of 3         1 of 2   0.25  2026-01-31\n"
            "zero-shear  not yet                                     -              -      -           -\n");
  const Json list = studies_json(studies)["studies"];
  EXPECT_EQ(list[0]["statements_that_hold"], 2);
  EXPECT_EQ(list[0]["checks_passed"], 1);
  EXPECT_EQ(list[0]["title"], "Diffusion");
  EXPECT_TRUE(list[1]["processor_hours"].is_null());
}

TEST_F(Studies, WithADamagedFindingAreRefused) {
  add("diffusion", R"({"title": "Diffusion"})");
  try {
    read_studies(folder_.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), (folder_.path() / "diffusion" / "study.json").string());
  }
}

TEST_F(Studies, ThatAreNotThereAreRefusedWithTheNamesOfThoseThatAre) {
  add("diffusion", "");
  StudyOptions options;
  options.name = "difusion";
  options.results = folder_.path();
  try {
    perform_study(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.value(), "difusion");
    EXPECT_EQ(error.allowed(), "must be one of: diffusion");
  }
}

TEST_F(Studies, RunTheirDriverAndReturnItsExitCode) {
  add("diffusion", "");
  StudyOptions options;
  options.name = "diffusion";
  options.results = folder_.path();
  EXPECT_EXIT(perform_study(options), testing::ExitedWithCode(3), "");
}

TEST_F(Studies, ThatHaveNoKindsOfRowsAreOfStatements) {
  add("diffusion", R"({"title": "Diffusion", "verdict": "not yet", "processor_hours": 1, "date": "2026-01-31",
    "statements": [{"answer": "holds"}, {"answer": "open"}]})");
  const std::vector<StudySummary> studies = read_studies(folder_.path());
  EXPECT_EQ(studies[0].holding, 1);
  EXPECT_EQ(studies[0].statements, 2);
  EXPECT_EQ(studies[0].checks, 0);
}

TEST_F(Studies, AreAllMadeOnlyWhenHoursAreMeant) {
  add("diffusion", found);
  StudyOptions options;
  options.all = true;
  options.results = folder_.path();
  try {
    perform_study(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "--all");
    EXPECT_EQ(error.allowed(), "must stand with --overnight: 0.25 hours of processor time");
  }
}

TEST_F(Studies, AreAllMadeByTheDriverOfAll) {
  add("diffusion", found);
  std::filesystem::create_directories(folder_.path() / "studies");
  std::ofstream(folder_.path() / "studies" / "overnight.py") << R"(import sys
raise SystemExit(7 if sys.argv[2:] == ["/campaigns"] else 8)
)";
  StudyOptions options;
  options.all = options.overnight = true;
  options.results = folder_.path();
  options.folder = "/campaigns";
  EXPECT_EXIT(perform_study(options), testing::ExitedWithCode(7), "");
}

TEST_F(Studies, NeedNoFolderToBeListed) {
  StudyOptions options;
  options.results = folder_.path();
  options.folder = "/campaigns";
  EXPECT_THROW(perform_study(options), InputError);
}

TEST_F(Studies, TellTheirDriverWhatWasAsked) {
  add("diffusion", "");
  std::ofstream(folder_.path() / "diffusion" / "study.py") << R"(import sys
raise SystemExit(7 if sys.argv[2:] == ["/campaigns", "--long", "--times", "4"] else 8)
)";
  StudyOptions options;
  options.name = "diffusion";
  options.results = folder_.path();
  options.folder = "/campaigns";
  options.with_long = true;
  options.times = 4;
  EXPECT_EXIT(perform_study(options), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace peclet::runner
