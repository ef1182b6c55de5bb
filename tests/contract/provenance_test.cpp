#include "contract/provenance.h"

#include <gtest/gtest.h>

#include "contract/sha256.h"

namespace peclet {
namespace {

TEST(Provenance, SaysAllThatIsNeededToBuildTheProgramAgain) {
  const Json& facts = provenance();
  for (const char* key :
       {"version", "git_commit", "binary_sha256", "compiler", "flags", "build_type", "cpu"}) {
    ASSERT_TRUE(facts.contains(key)) << key;
    EXPECT_TRUE(facts[key].is_string()) << key;
  }
  EXPECT_EQ(facts["version"], version());
  const auto commit = facts["git_commit"].get<std::string>();
  EXPECT_TRUE(commit == "unknown" || commit.size() == 40) << commit;
  EXPECT_EQ(facts["git_dirty"].is_null(), commit == "unknown");
  EXPECT_EQ(facts["binary_sha256"], sha256_of_file("/proc/self/exe"));
  EXPECT_NE(facts["flags"].get<std::string>().find("-ffp-contract=off"), std::string::npos);
}

}  // namespace
}  // namespace peclet
