#include "runner/maintenance/backup.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/reports/export.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "runner/store/result_files.h"
#include "tests/runner/campaign_process.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// A realisation takes 20 ms.
const Environment slow{{"PECLET_FAKE_STEP_MS", "2"}};

std::string canonical_export(const fs::path& database) {
  Database reader = Database::open_reader(database);
  return export_json(reader, true);
}

// Returns the export of a campaign that is not disturbed.
std::string undisturbed() {
  CampaignOnDisk campaign;
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  return canonical_export(campaign.directory().database());
}

// Writes invalid bytes into the middle of a database.
void damage_file(const fs::path& path) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096);
  const std::string noise(8192, '\xa5');
  file.write(noise.data(), static_cast<std::streamsize>(noise.size()));
}

TEST(Backups, HoldWhatIsCommittedAndNothingElse) {
  StoredCampaign stored(1, 5, 50);
  stored.complete(0, 0, 10);
  Transaction open(stored.database().connection());
  stored.database().connection().execute("DELETE FROM result");
  const TemporaryFolder target;
  const Backup backup = make_backup(stored.directory(), target.path() / "copies", false);
  EXPECT_EQ(backup.results, 1);
  EXPECT_EQ(examine(backup.file).results, 1);
  EXPECT_FALSE(examine(backup.file).backed_up_at.empty());
}

// Like /mnt/usb/copies if nothing is mounted at /mnt/usb, and that folder does not exist.
TEST(Backups, ToAFolderThatIsNotMountedAreRefused) {
  StoredCampaign stored(1, 5, 50);
  const TemporaryFolder target;
  const fs::path usb = target.path() / "usb";
  try {
    make_backup(stored.directory(), usb / "copies", false);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("there is no folder " + usb.string() + ": mount its disk"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(fs::exists(usb));
  fs::create_directory(usb);
  make_backup(stored.directory(), usb / "copies", false);
  EXPECT_TRUE(fs::exists(newest_backup(usb / "copies")));
}

// A link in the spool or among the checkpoints would copy another user's file.
TEST(Backups, TakeNoLinksAlong) {
  StoredCampaign stored(1, 5, 50);
  create_folders(stored.directory());
  const TemporaryFolder target;
  write_durably(target.path() / "secret", "secret");
  fs::create_symlink(target.path() / "secret", stored.directory().checkpoints() / "a.checkpoint");
  write_durably(stored.directory().checkpoints() / "b.checkpoint", "b");
  write_durably(stored.directory().checkpoints() / "b.checkpoint@growing", "beside b");
  const Backup backup = make_backup(stored.directory(), target.path() / "copies", true);
  EXPECT_EQ(backup.checkpoints, 1);
  EXPECT_FALSE(fs::exists(target.path() / "copies" / "checkpoints" / "a.checkpoint"));
  EXPECT_EQ(read_file(target.path() / "copies" / "checkpoints" / "b.checkpoint"), "b");
  EXPECT_EQ(read_file(target.path() / "copies" / "checkpoints" / "b.checkpoint@growing"), "beside b");
}

TEST(Backups, KeepTwoGenerations) {
  StoredCampaign stored(1, 5, 50);
  const fs::path folder = stored.directory().backup();
  for (int seed = 0; seed < 3; ++seed) {
    stored.complete(0, seed, 10);
    make_backup(stored.directory(), folder, false);
  }
  EXPECT_EQ(examine(newest_backup(folder)).results, 3);
  EXPECT_EQ(examine(previous_backup(folder)).results, 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
}

TEST(Backups, OfADamagedDatabaseAreNotMadeAndTheEarlierStay) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const fs::path folder = campaign.directory().backup();
  const std::string before = read_file(newest_backup(folder));
  damage_file(campaign.directory().database());
  EXPECT_THROW(make_backup(campaign.directory(), folder, false), IntegrityError);
  EXPECT_EQ(read_file(newest_backup(folder)), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(Backups, NeverReplaceThoseOfAnotherCampaignOrACampaignItself) {
  StoredCampaign stored(1, 5, 50), other(1, 5, 50);
  stored.complete(0, 0, 10);
  other.database().connection().execute("UPDATE campaign SET created_at = '2001-01-01T00:00:00Z'");
  make_backup(other.directory(), other.directory().backup(), false);
  EXPECT_THROW(make_backup(stored.directory(), other.directory().backup(), false), InputError);
  const OwnerLock lock(other.directory());
  EXPECT_THROW(make_backup(stored.directory(), other.directory().root(), false), InputError);
}

TEST(Backups, BelongToTheCampaignWhateverItIsCalledSince) {
  StoredCampaign stored(1, 5, 50);
  make_backup(stored.directory(), stored.directory().backup(), false);
  stored.database().connection().execute("UPDATE campaign SET name = 'other'");
  EXPECT_NO_THROW(make_backup(stored.directory(), stored.directory().backup(), false));
}

TEST(Backups, AnOlderCopyInThePlaceOfTheDatabaseIsRefused) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 8;
  campaign.run();
  const fs::path copy = campaign.directory().root() / "copy";
  fs::copy_file(campaign.directory().database(), copy);
  campaign.document["sweep"][0]["values"].push_back(7);  // one more point of eight seeds
  const int code = campaign.run();
  ASSERT_TRUE(code == 0 || code == 3) << campaign.log();
  const std::int64_t results = campaign.count("SELECT count(*) FROM result");
  fs::copy_file(copy, campaign.directory().database(), fs::copy_options::overwrite_existing);
  EXPECT_EQ(campaign.run(), 6);
  EXPECT_NE(campaign.log().find("is older than its own backup"), std::string::npos) << campaign.log();
  RestoreOptions restore;
  restore.backup = campaign.directory().backup();
  restore.campaign = campaign.options.campaign;
  restore_campaign(restore);
  EXPECT_EQ(campaign.run(), code) << campaign.log();
  EXPECT_EQ(campaign.count("SELECT count(*) FROM result"), results);
}

TEST(Restoring, AnOlderBackupByForceIsWhatCountsFromThenOn) {
  CampaignOnDisk campaign;
  campaign.document["realisations"]["maximum"] = 8;
  campaign.run();
  const TemporaryFolder medium;
  make_backup(campaign.directory(), medium.path(), false);
  campaign.document["sweep"][0]["values"].push_back(7);
  const int code = campaign.run();
  ASSERT_TRUE(code == 0 || code == 3) << campaign.log();
  RestoreOptions restore;
  restore.backup = medium.path();
  restore.campaign = campaign.options.campaign;
  EXPECT_THROW(restore_campaign(restore), InputError);
  restore.force = true;
  EXPECT_NE(restore_campaign(restore).find("has more in it"), std::string::npos);
  EXPECT_EQ(campaign.run(), code) << campaign.log();
}

TEST(Backups, OfARunningCampaignAreSoundAndGrow) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7, slow));
  campaign.wait_for_results(1);
  const TemporaryFolder target;
  std::int64_t results = 0;
  for (int count = 0; count < 5; ++count) {
    const Backup backup = make_backup(campaign.directory(), target.path(), true);
    EXPECT_GE(examine(backup.file).results, results);
    results = backup.results;
  }
  campaign.release();
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
}

// The first run is killed, so its backups were made while it lasted. The second one backs up at its end only.
TEST(Backups, AreMadeByTheRunItself) {
  CampaignOnDisk campaign;
  const fs::path folder = campaign.directory().backup();
  campaign.options.backup_seconds = 0.1;
  campaign.start({{"PECLET_FAKE_STEP_MS", "500"}});
  for (int tries = 0; tries < 6000 && !fs::exists(newest_backup(folder)); ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_TRUE(fs::exists(newest_backup(folder))) << campaign.log();
  campaign.signal(SIGKILL);
  EXPECT_EQ(campaign.finish(), -SIGKILL);
  campaign.options.backup_seconds = 600;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_EQ(examine(newest_backup(folder)).results, campaign.count("SELECT count(*) FROM result"));
  EXPECT_EQ(examine(newest_backup(folder)).attempts, campaign.count("SELECT max(attempt_id) FROM attempt"));
  EXPECT_LT(examine(previous_backup(folder)).attempts, examine(newest_backup(folder)).attempts);
}

TEST(Restoring, ElsewhereGoesOnToTheSameBytes) {
  CampaignOnDisk campaign;
  campaign.options.checkpoint_seconds = 0.005;
  campaign.start(campaign.held_from(7, slow));
  campaign.wait_for_results(8);
  const TemporaryFolder medium;
  make_backup(campaign.directory(), medium.path(), true);
  campaign.signal(SIGKILL);  // the first machine is lost
  campaign.finish();

  CampaignOnDisk elsewhere;
  RestoreOptions restore;
  restore.backup = medium.path();
  restore.campaign = elsewhere.options.campaign;
  restore_campaign(restore);
  EXPECT_GE(elsewhere.count("SELECT count(*) FROM result"), 8);
  EXPECT_EQ(elsewhere.run(), 0) << elsewhere.log();
  EXPECT_EQ(canonical_export(elsewhere.directory().database()), undisturbed());
  // Seeds whose results came with the backup were not run again.
  EXPECT_EQ(elsewhere.count("SELECT count(*) FROM (SELECT 1 FROM attempt WHERE outcome = 'result' GROUP BY "
                            "point_id, seed HAVING count(*) > 1)"),
            0);
}

TEST(Restoring, AfterTheDatabaseIsDestroyedGoesOnWithWhatTheSpoolGives) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7, slow));
  campaign.wait_for_results(4);
  make_backup(campaign.directory(), campaign.directory().backup(), false);
  campaign.wait_for_results(8);
  campaign.signal(SIGKILL);
  campaign.finish();
  // Spools a result that the owner could not commit before it died.
  {
    Database before = campaign.reader();
    const PointRecord point = before.points().at(0);
    const Json result = before.result(point.id, 0).value();
    write_durably(campaign.directory().spool_file(point.hash, 0, 999), result.dump());
  }
  const std::string damaged(20'000, '\xa5');
  write_durably(campaign.directory().database(), damaged);
  fs::remove(campaign.directory().database().string() + "-wal");
  EXPECT_EQ(campaign.run(), 6);
  EXPECT_NE(campaign.log().find("put the last one back with `peclet restore"), std::string::npos);

  RestoreOptions restore;
  restore.backup = campaign.directory().backup();
  restore.campaign = campaign.directory().root();
  restore_campaign(restore);
  EXPECT_EQ(read_file(campaign.directory().aside() / "1" / "campaign.db"), damaged);
  EXPECT_EQ(campaign.run(), 0) << campaign.log();
  EXPECT_TRUE(spool_files(campaign.directory()).empty());
  EXPECT_EQ(canonical_export(campaign.directory().database()), undisturbed());
}

TEST(Restoring, NeverReplacesASoundDatabaseThatIsAsNewUnlessForced) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  RestoreOptions restore;
  restore.backup = campaign.directory().backup();
  restore.campaign = campaign.options.campaign;
  EXPECT_THROW(restore_campaign(restore), InputError);
  EXPECT_FALSE(fs::exists(campaign.directory().aside()));
  restore.force = true;
  restore_campaign(restore);
  EXPECT_TRUE(fs::exists(campaign.directory().aside() / "1" / "campaign.db"));
}

TEST(Restoring, IsRefusedWhileAnOwnerRuns) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  const OwnerLock lock(campaign.directory());
  RestoreOptions restore;
  restore.backup = campaign.directory().backup();
  restore.campaign = campaign.options.campaign;
  restore.force = true;
  EXPECT_THROW(restore_campaign(restore), OwnedByAnother);
}

TEST(Restoring, TakesTheGenerationBeforeADamagedOne) {
  StoredCampaign stored(1, 5, 50);
  const fs::path folder = stored.directory().backup();
  for (int seed = 0; seed < 2; ++seed) {
    stored.complete(0, seed, 10);
    make_backup(stored.directory(), folder, false);
  }
  damage_file(newest_backup(folder));
  const TemporaryFolder elsewhere;
  RestoreOptions restore;
  restore.backup = folder;
  restore.campaign = elsewhere.path() / "moved.peclet";
  const std::string text = restore_campaign(restore);
  EXPECT_NE(text.find("backup.previous.db"), std::string::npos) << text;
  EXPECT_EQ(examine(elsewhere.path() / "moved.peclet" / "campaign.db").results, 1);
  EXPECT_TRUE(fs::exists(elsewhere.path() / "moved.json"));
  EXPECT_THROW(restore_campaign({elsewhere.path(), elsewhere.path() / "nothing", {}}), InputError);
}

TEST(Restoring, IsNotTheCureForADatabaseOfAnotherVersion) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  Connection(campaign.directory().database().string(), Connection::Access::read_write, 0)
      .execute("PRAGMA user_version = 1000");
  EXPECT_EQ(campaign.run(), 2);
  EXPECT_NE(campaign.log().find("another peclet"), std::string::npos);
  EXPECT_EQ(campaign.log().find("peclet restore"), std::string::npos) << campaign.log();
}

TEST(Restoring, ALostDatabaseIsNotStartedAfresh) {
  CampaignOnDisk campaign;
  ASSERT_EQ(campaign.run(), 0) << campaign.log();
  fs::remove(campaign.directory().database());
  EXPECT_EQ(campaign.run(), 6);
  EXPECT_FALSE(fs::exists(campaign.directory().database()));
}

}  // namespace
}  // namespace peclet::runner
