// Deleting and moving the folder of a running campaign.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "runner/maintenance/backup.h"
#include "runner/owner/owned_campaign.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "tests/runner/campaign_process.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// A realisation takes 0.1 s: some end before the watch notices that their folders are gone.
const Environment slow{{"PECLET_FAKE_STEP_MS", "10"}};

class FolderWatched : public testing::Test {
 protected:
  FolderWatched() {
    campaign_.start(campaign_.held_from(7, slow));
    campaign_.wait_for_results(3);
  }
  // Expects that no seed was blamed for what happened to its folders.
  void expect_undisturbed_answer(const fs::path& database) {
    CampaignOnDisk undisturbed;
    ASSERT_EQ(undisturbed.run(), 0) << undisturbed.log();
    EXPECT_EQ(campaign_.answer(), undisturbed.answer());
    Database reader = Database::open_reader(database);
    EXPECT_EQ(reader.connection().integer("SELECT count(*) FROM realisation WHERE state = 'quarantined'"), 0);
  }
  std::string saved() const { return campaign_.directory().root().string() + ".saved.db"; }

  CampaignOnDisk campaign_;
};

TEST_F(FolderWatched, ADeletedDatabaseIsSavedAndTheRunStops) {
  const std::int64_t results = campaign_.count("SELECT count(*) FROM result");
  fs::remove(campaign_.directory().database());
  EXPECT_EQ(campaign_.finish(), 6);
  EXPECT_NE(campaign_.log().find("peclet restore " + saved()), std::string::npos) << campaign_.log();
  EXPECT_GE(examine(saved()).results, results);
  RestoreOptions restore;
  restore.backup = saved();
  restore.campaign = campaign_.options.campaign;
  restore_campaign(restore);
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  expect_undisturbed_answer(campaign_.directory().database());
}

TEST_F(FolderWatched, ADeletedFolderIsNoticedAndItsDatabaseSavedBesideIt) {
  const std::int64_t results = campaign_.count("SELECT count(*) FROM result");
  while (fs::exists(campaign_.directory().root())) {
    std::error_code raced;  // workers write into it meanwhile
    fs::remove_all(campaign_.directory().root(), raced);
  }
  EXPECT_EQ(campaign_.finish(), 6);
  EXPECT_GE(examine(saved()).results, results);
}

TEST_F(FolderWatched, AMovedFolderIsNamedAndGoesOnWhereItIs) {
  const fs::path moved = campaign_.directory().root().parent_path() / "moved.peclet";
  fs::rename(campaign_.directory().root(), moved);
  EXPECT_EQ(campaign_.finish(), 6);
  EXPECT_NE(campaign_.log().find("--directory " + moved.string()), std::string::npos) << campaign_.log();
  fs::rename(moved, campaign_.directory().root());
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  expect_undisturbed_answer(campaign_.directory().database());
}

TEST_F(FolderWatched, FoldersBelowAreMadeAnewAndNoSeedIsGivenUp) {
  for (const fs::path& folder : {campaign_.directory().spool(), campaign_.directory().checkpoints(),
                                 campaign_.directory().failures(), campaign_.directory().logs()}) {
    const fs::path gone = folder.string() + ".gone";
    fs::rename(folder, gone);  // in one step, whatever the run does in it
    fs::remove_all(gone);
  }
  campaign_.wait_until("what the watch says", [&] {
    return campaign_.log().find("are made anew: spool/, checkpoints/, failures/, logs/;") !=
           std::string::npos;
  });
  campaign_.release();
  EXPECT_EQ(campaign_.finish(), 0) << campaign_.log();
  expect_undisturbed_answer(campaign_.directory().database());
}

TEST(FolderWatchedOfFiles, FoldersOfFilesAreMadeAnewAndNobodyIsBlamed) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7, {{"PECLET_FAKE_STEP_MS", "10"}, {"PECLET_FAKE_FILES", "2"}}));
  campaign.wait_for_results(3);
  const auto delete_and_wait = [&](const fs::path& folder, const std::string& name) {
    fs::remove_all(folder);
    campaign.wait_until("what the watch says",
                        [&] { return campaign.log().find("are made anew: " + name) != std::string::npos; });
  };
  // One after the other: a rejected result makes the folder for rejected files anew.
  delete_and_wait(campaign.directory().rejected(), "spool/rejected/");
  delete_and_wait(campaign.directory().left(), "spool/files/");
  campaign.release();
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT total(blamed) FROM attempt"), 0) << campaign.log();
}

TEST(FolderWatch, SaysNothingOfAWholeFolderAndNeverReplacesWhatWasSavedBefore) {
  StoredCampaign stored(1, 5, 50);
  stored.complete(0, 0, 10);
  create_folders(stored.directory());
  const OwnerLock lock(stored.directory());
  SilentListener listener;
  const CampaignDirectory directory = stored.directory();
  FolderWatch watch(directory, lock, stored.database(), listener);
  FolderWatch::Time now{};
  EXPECT_NO_THROW(watch.attend(now += std::chrono::seconds(2)));
  EXPECT_TRUE(listener.warnings.empty());
  fs::rename(directory.database(), directory.root() / "hidden.db");
  EXPECT_THROW(watch.attend(now += std::chrono::seconds(2)), IntegrityError);
  EXPECT_THROW(watch.attend(now += std::chrono::seconds(2)), IntegrityError);
  for (const char* const name : {".saved.db", ".saved.db.1"}) {
    const fs::path copy = directory.root().string() + name;
    EXPECT_EQ(examine(copy).results, 1) << copy;
    fs::remove(copy);
  }
}

}  // namespace
}  // namespace peclet::runner
