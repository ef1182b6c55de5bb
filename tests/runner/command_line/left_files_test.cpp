// Files that realisations leave, through whole runs: faults of the engine, tasks of a batch system, backups,
// the doctor, and what the verbs say of them.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/command_line/ask_owner.h"
#include "runner/maintenance/backup.h"
#include "runner/maintenance/doctor.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/store/result_files.h"
#include "tests/runner/batch/batch_fixture.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

std::set<std::string> files_below(const fs::path& folder) {
  std::set<std::string> found;
  if (!fs::exists(folder)) return found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) found.insert(entry.path().lexically_relative(folder.parent_path()).string());
  }
  return found;
}

// Expects the files of the table in the folder, and no others. Returns their number.
std::size_t expect_all_in_place(const CampaignDirectory& directory) {
  Database reader = Database::open_reader(directory.database());
  std::set<std::string> known;
  for (const FileRecord& record : files_in(reader.connection())) {
    if (!record.kept) continue;
    const fs::path place = record.place(directory);
    known.insert(place.lexically_relative(directory.root()).string());
    EXPECT_EQ(fs::exists(place) ? sha256_of_file(place) : "nothing", record.file.sha256) << place;
  }
  EXPECT_EQ(files_below(directory.files()), known);
  EXPECT_TRUE(fs::is_empty(directory.left()));
  return known.size();
}

class LeftFiles : public testing::Test {
 protected:
  // Each point needs eight seeds, or a few more.
  LeftFiles() { campaign_.document["target"]["relative_tolerance"] = 0.5; }
  void run(const Environment& environment = {{"PECLET_FAKE_FILES", "2"}}) {
    ASSERT_EQ(campaign_.run(environment), 0) << campaign_.log();
  }
  std::int64_t done() const { return campaign_.count("SELECT count(*) FROM result"); }
  fs::path place(int seed) {
    Database reader = campaign_.reader();
    const std::int64_t point = reader.points().at(0).id;
    return files_of_seed(reader.connection(), point, seed).at(0).place(campaign_.directory());
  }
  Json findings(bool repair = false) {
    DoctorOptions options;
    options.campaign = campaign_.options.campaign;
    options.repair = repair;
    options.json = true;
    Json found = Json::object();
    const Json diagnosis = Json::parse(examine_campaign(options).text);
    for (const Json& finding : diagnosis.at("findings")) found[finding.at("code")] = finding;
    return found;
  }

  CampaignOnDisk campaign_;
};

TEST_F(LeftFiles, OfAWholeRunAreInTheirPlaces) {
  run();
  EXPECT_EQ(expect_all_in_place(campaign_.directory()), 2U * static_cast<std::size_t>(done()));
}

TEST_F(LeftFiles, ThatAnEngineLiesAboutAreTurnedDownWithItsResult) {
  run({{"PECLET_FAKE_FILES", "2"}, {"PECLET_FAKE_FAULTS", "lose:1x1 tamper:2x1 escape:3x1"}});
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM attempt WHERE outcome = 'garbled'"), 6);  // of two points
  for (const char* const why : {"its file state-0.txt is missing",
                                "its file state-0.txt does not have its hash", "/files/0/name: must be"}) {
    EXPECT_NE(campaign_.log().find(why), std::string::npos) << why;
  }
  EXPECT_EQ(expect_all_in_place(campaign_.directory()), 2U * static_cast<std::size_t>(done()));
  EXPECT_FALSE(fs::exists(campaign_.directory().root() / "state-0.txt"));
}

TEST_F(LeftFiles, ThatTheCampaignDoesNotKeepAreNoted) {
  campaign_.document["keep_files"] = 3;
  run();
  EXPECT_EQ(expect_all_in_place(campaign_.directory()), 2U * 3 * 2);
  EXPECT_EQ(campaign_.count("SELECT count(*) FROM file WHERE kept = 0"), 2 * (done() - 6));
}

TEST_F(LeftFiles, ARuleForTheFutureIsSet) {
  campaign_.document["keep_files"] = "none";
  run();
  const std::int64_t before = done();
  SetOptions options;
  options.campaign = campaign_.options.campaign;
  options.tolerance = 0.06;
  options.keep_files = "all";
  const Reply reply = set_campaign(options);
  EXPECT_NE(reply.text.find("files kept \"none\" -> \"all\""), std::string::npos) << reply.text;
  campaign_.document = Json::parse(read_file(options.campaign));
  EXPECT_EQ(campaign_.document["keep_files"], "all");
  run();
  EXPECT_GT(done(), before);
  EXPECT_EQ(expect_all_in_place(campaign_.directory()), 2U * static_cast<std::size_t>(done() - before));
  options.keep_files = "some";
  EXPECT_THROW(set_campaign(options), InputError);
  options.keep_files = "5";
  set_campaign(options);
  EXPECT_EQ(Json::parse(read_file(options.campaign))["keep_files"], 5);
}

TEST_F(LeftFiles, AreToldByExplainAndExport) {
  campaign_.document["keep_files"] = 5;
  run();
  Database reader = campaign_.reader();
  const PointRecord point = reader.points().at(0);
  const fs::path folder = place(0).parent_path().parent_path();
  const Json told = explain_json(reader, campaign_.directory(), "").at("points").at(0).at("files");
  EXPECT_EQ(told.at("kept"), 10);
  EXPECT_EQ(told.at("folder"), folder.string());
  std::uintmax_t bytes = 0;
  for (const std::string& file : files_below(folder)) bytes += fs::file_size(folder.parent_path() / file);
  EXPECT_EQ(told.at("bytes"), bytes);
  EXPECT_NE(
      explain(reader, campaign_.directory(), "").find("  files: 10 (0.0 MB) in " + folder.string() + "; "),
      std::string::npos);
  const Json document = Json::parse(export_json(reader, false));
  const Json& seeds = document.at("points").at(0).at("realisations");
  EXPECT_EQ(seeds.at(0).at("files").at(1).at("name"), "state-1.txt");
  EXPECT_EQ(seeds.at(4).at("files").at(0).at("path"),
            place(4).lexically_relative(campaign_.directory().root()).string());
  EXPECT_TRUE(seeds.at(5).at("files").at(0).at("path").is_null());
  EXPECT_EQ(export_json(reader, true).find("state-0.txt"), std::string::npos);
}

TEST_F(LeftFiles, AreFoundMissingDamagedAndOrphanedAndBroughtBack) {
  run();
  EXPECT_TRUE(findings().empty()) << findings();
  fs::remove(place(0));
  Json found = findings();
  EXPECT_EQ(found.at("file-missing").at("severity"), "warning");
  EXPECT_NE(found.at("file-missing").at("message").get<std::string>().find("000000/state-0.txt"),
            std::string::npos);
  // The backup at the end of the run has it.
  EXPECT_TRUE(found.at("file-missing").at("repairable"));
  EXPECT_EQ(findings(true).at("file-missing").at("repaired"), true);
  EXPECT_TRUE(findings().empty()) << findings();
  expect_all_in_place(campaign_.directory());

  write_durably(place(1), "as long as it was? no");
  EXPECT_TRUE(findings().at("file-damaged").at("repairable"));
  findings(true);
  EXPECT_TRUE(findings().empty()) << findings();

  fs::remove(place(0));
  fs::remove_all(campaign_.directory().backup() / "files");
  EXPECT_FALSE(findings().at("file-missing").at("repairable"));
  write_durably(place(1).parent_path() / "stranger", "");
  EXPECT_NE(findings().at("file-orphan").at("message").get<std::string>().find("000001/stranger"),
            std::string::npos);
  write_durably(campaign_.directory().left() / "0123456789abcdef-000000-1@x", "");
  EXPECT_EQ(findings().at("file-left").at("severity"), "note");
}

TEST_F(LeftFiles, OfAResultThatTheDoctorRunsAgainComeAgain) {
  run();
  {
    Connection connection(campaign_.directory().database().string(), Connection::Access::read_write, 0);
    connection.execute("UPDATE result SET document = zeroblob(9) WHERE seed = 1");
  }
  EXPECT_TRUE(findings().contains("result-altered"));
  findings(true);
  run();
  EXPECT_TRUE(findings().contains("rejected-results"));
  EXPECT_EQ(expect_all_in_place(campaign_.directory()), 2U * static_cast<std::size_t>(done()));
}

TEST_F(LeftFiles, GoIntoABackupOnceAndComeOutOfIt) {
  run();
  const TemporaryFolder elsewhere;
  const fs::path copies = elsewhere.path() / "copies";
  const Backup first = make_backup(campaign_.directory(), copies, true);
  EXPECT_EQ(first.files.there, 2 * done());
  EXPECT_EQ(first.files.lacking, 0);
  const std::string name = sha256_of_file(place(0));
  struct stat before {
  }, after{};
  ASSERT_EQ(stat((copies / "files" / name).c_str(), &before), 0);
  fs::remove(place(1));
  const Backup second = make_backup(campaign_.directory(), copies, true);
  EXPECT_EQ(second.files.there, 2 * done()) << "what was copied once is there";
  ASSERT_EQ(stat((copies / "files" / name).c_str(), &after), 0);
  EXPECT_EQ(before.st_ino, after.st_ino) << "and is not copied again";

  const CampaignDirectory restored(elsewhere.path() / "other.peclet");
  restore_campaign({copies, restored.root(), {}});
  EXPECT_EQ(expect_all_in_place(restored), 2U * static_cast<std::size_t>(done()));

  fs::remove(copies / "files" / name);
  const CampaignDirectory again(elsewhere.path() / "again.peclet");
  const std::string text = restore_campaign({copies, again.root(), {}});
  EXPECT_NE(text.find("1 files of realisations are neither here nor beside the backup"), std::string::npos)
      << text;
}

using HandOverOfFiles = BatchFixture;

TEST_F(HandOverOfFiles, BringsThemHome) {
  set("PECLET_FAKE_FILES", "2");
  set("PECLET_FAKE_FAULTS", "tamper:1x1");
  ASSERT_EQ(hand_over(), 0);
  for (int index = 0; index < 5; ++index) run_task(1, index);
  ingest();
  EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'garbled'"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM result"), 8);
  EXPECT_EQ(expect_all_in_place(CampaignDirectory(folder() / "batch.peclet")), 16U);
  EXPECT_TRUE(fs::is_empty(shared() / "spool" / "files"));
  EXPECT_TRUE(files_below(bundle(1) / "tasks").empty() ||
              files_below(bundle(1) / "tasks").begin()->find("/files/") == std::string::npos);
}

// A task that died between the first file and the result is continued from there.
TEST_F(HandOverOfFiles, GoesOnWhereATaskDied) {
  set("PECLET_FAKE_FILES", "2");
  ASSERT_EQ(hand_over(), 0);
  ASSERT_EQ(run_task(1, 0), 0);
  const CampaignDirectory there(shared());
  for (const fs::directory_entry& entry : fs::directory_iterator(there.spool())) {
    if (!entry.is_regular_file()) continue;
    const fs::path home = bundle(1) / "tasks" / "0";
    const fs::path unpublished = home / (entry.path().stem().string() + ".result");
    fs::rename(left_file(entry.path(), "state-1.txt"), left_file(unpublished, "state-1.txt"));
    fs::rename(entry.path(), unpublished);
  }
  for (int index = 0; index < 5; ++index) ASSERT_EQ(run_task(1, index), 0);
  EXPECT_EQ(ingest(), 0);
  EXPECT_EQ(answer(), local_answer());
  EXPECT_EQ(expect_all_in_place(CampaignDirectory(folder() / "batch.peclet")), 20U);
  EXPECT_FALSE(fs::exists(bundle(1)));
}

}  // namespace
}  // namespace peclet::runner
