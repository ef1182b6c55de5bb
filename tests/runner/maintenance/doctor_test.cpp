#include "runner/maintenance/doctor.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "runner/engines/engine_process.h"
#include "runner/maintenance/backup.h"
#include "runner/reports/export.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "runner/store/result_store.h"
#include "tests/runner/campaign_process.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class Doctor : public testing::Test {
 protected:
  Doctor() { EXPECT_EQ(campaign_.run(), 0) << campaign_.log(); }

  Diagnosis examine(bool repair = false) {
    DoctorOptions options;
    options.campaign = campaign_.options.campaign;
    options.repair = repair;
    options.json = true;
    return examine_campaign(options);
  }
  // Returns the severity of a finding; "" if it is not found.
  std::string severity(const std::string& code) {
    const Json diagnosis = Json::parse(examine().text);
    for (const Json& finding : diagnosis.at("findings")) {
      if (finding.at("code") == code) return finding.at("severity");
    }
    return "";
  }
  void edit(const std::string& sql) {
    Connection connection(campaign_.directory().database().string(), Connection::Access::read_write, 0);
    connection.execute(sql);
  }
  // Changes the viscosity in the stored result of a seed and in its numbers.
  void alter(int seed, double viscosity) {
    Json result;
    {
      Database reader = campaign_.reader();
      result = reader.result(reader.points().at(0).id, seed).value();
    }
    result["mean"]["relative_viscosity"] = viscosity;
    Connection connection(campaign_.directory().database().string(), Connection::Access::read_write, 0);
    Statement(connection, "UPDATE result SET document = ? WHERE seed = ?")
        .bind_blob(deflated(result.dump(), ""))
        .bind(seed)
        .run();
    Statement(connection, "UPDATE numbers SET numbers = json_replace(numbers, '$[0]', ?) WHERE seed = ?")
        .bind(viscosity)
        .bind(seed)
        .run();
  }
  std::string exported() {
    Database reader = campaign_.reader();
    return export_json(reader, true);
  }

  CampaignOnDisk campaign_;
};

TEST_F(Doctor, FindsNothingWrongWithASoundCampaign) {
  const Diagnosis diagnosis = examine();
  EXPECT_EQ(diagnosis.exit_code, 0) << diagnosis.text;
  EXPECT_EQ(Json::parse(diagnosis.text).at("schema_version"), 1);
}

// A checkpoint of a seed that was not needed is a note, not a fault.
TEST_F(Doctor, ANoteIsNoFinding) {
  const std::string hash = campaign_.reader().points().at(0).hash;
  std::ofstream(campaign_.directory().checkpoint(hash, 39)) << "state";
  DoctorOptions options;
  options.campaign = campaign_.options.campaign;
  const Diagnosis diagnosis = examine_campaign(options);
  EXPECT_EQ(diagnosis.exit_code, 0);
  EXPECT_NE(diagnosis.text.find(": sound, 1 note\n\nnote: 1 files in checkpoints/"), std::string::npos)
      << diagnosis.text;
}

struct Fault {
  const char *sql, *code, *severity;
};

TEST_F(Doctor, FindsWhatContradictsItself) {
  const Fault faults[] = {
      {"UPDATE result SET document = (SELECT document FROM result WHERE seed = 0) WHERE seed = 1",
       "result-altered", "integrity"},
      {"UPDATE result SET document = zeroblob(9) WHERE seed = 1", "result-altered", "integrity"},
      {"UPDATE dictionary SET text = '{}'", "dictionary-altered", "integrity"},
      {"DELETE FROM dictionary", "dictionary-altered", "integrity"},
      {"DELETE FROM result WHERE seed = 1", "result-altered", "integrity"},
      {"UPDATE numbers SET numbers = json_replace(numbers, '$[0]', 3.5) WHERE seed = 1", "result-altered",
       "integrity"},
      {"DELETE FROM numbers WHERE seed = 1", "result-altered", "integrity"},
      {"UPDATE numbers SET numbers = '[1,2]' WHERE seed = 1", "result-altered", "integrity"},
      {"UPDATE stop_test SET mean = mean + 1", "stop-test-differs", "integrity"},
      {"UPDATE realisation SET final_state_sha256 = (SELECT final_state_sha256 FROM realisation WHERE seed = "
       "0) "
       "WHERE seed = 1",
       "seeds-repeated", "warning"},
      {"UPDATE point SET suspect = 1", "suspect", "integrity"},
      {"PRAGMA foreign_keys = OFF; DELETE FROM engine", "database-damaged", "integrity"},
      {"INSERT INTO lease SELECT point_id, seed, attempt_id, 0, '', 0, 0, 0, '' FROM attempt LIMIT 1",
       "lease-adrift", "integrity"},
      {"UPDATE event SET at = '2999-01-01T00:00:00Z' WHERE event_id = 1", "clock-ahead", "warning"},
      {"UPDATE event SET at = '2999-01-01T00:00:00Z' WHERE event_id = 1", "clock-backwards", "note"},
  };
  const fs::path database = campaign_.directory().database();
  const std::string sound = read_file(database);
  for (const Fault& fault : faults) {
    EXPECT_EQ(severity(fault.code), "") << fault.sql;
    edit(fault.sql);
    EXPECT_EQ(severity(fault.code), fault.severity) << fault.sql << '\n' << examine().text;
    // An edited state contradicts its result, too.
    const bool is_broken =
        std::string(fault.severity) == "integrity" || std::string(fault.code) == "seeds-repeated";
    EXPECT_EQ(examine().exit_code, is_broken ? 6 : 1) << fault.sql;
    for (const char* const suffix : {"-wal", "-shm"}) fs::remove(database.string() + suffix);
    write_durably(database, sound);
  }
}

TEST_F(Doctor, RepairsAnAlteredResultByRunningItsSeedAgain) {
  const std::string before = exported();
  alter(1, 7.0);
  EXPECT_EQ(examine(true).exit_code, 0);
  EXPECT_FALSE(fs::is_empty(campaign_.directory().rejected()));
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  EXPECT_EQ(exported(), before);
  fs::remove_all(campaign_.directory().rejected());
  EXPECT_EQ(examine().exit_code, 0) << examine().text;
}

// The sum of such values would be infinite.
TEST_F(Doctor, AValueBeyondAllSumsIsFoundAndRunAgain) {
  const std::string before = exported();
  alter(1, 1.7e308);
  EXPECT_EQ(severity("result-altered"), "integrity");
  EXPECT_NE(examine().text.find("/mean/relative_viscosity: must be a number between"), std::string::npos);
  EXPECT_EQ(examine(true).exit_code, 0) << examine().text;
  EXPECT_EQ(campaign_.run(), 0) << campaign_.log();
  EXPECT_EQ(exported(), before);
}

TEST_F(Doctor, SaysWhoKeepsTheLogFromBecomingSmall) {
  Connection owner(campaign_.directory().database().string(), Connection::Access::read_write, 0);
  EXPECT_EQ(severity("log-large"), "");
  // Starts a reader that stays in the middle of its work, as a stopped one does.
  int ready[2] = {};
  ASSERT_EQ(pipe(ready), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    const Database database = Database::open_reader(campaign_.directory().database());
    if (write(ready[1], "x", 1) != 1) _exit(1);
    for (;;) pause();
  }
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  owner.execute("CREATE TABLE ballast (bytes BLOB)");
  for (int i = 0; i < 40; ++i)
    owner.execute("DELETE FROM ballast; INSERT INTO ballast VALUES (randomblob(1000000))");
  owner.execute("DROP TABLE ballast");
  EXPECT_EQ(severity("log-large"), "warning");
  EXPECT_NE(examine().text.find("process " + std::to_string(reader) + " ("), std::string::npos)
      << examine().text;
  kill(reader, SIGKILL);
  waitpid(reader, nullptr, 0);
  for (const int end : ready) close(end);
}

TEST_F(Doctor, RepeatsStopTestsThatDiffer) {
  const std::string before = exported();
  edit("UPDATE stop_test SET mean = mean + 1");
  EXPECT_EQ(examine(true).exit_code, 0);
  EXPECT_EQ(exported(), before);
}

TEST_F(Doctor, NamesFilesAndRemovesOnlyThoseThatNobodyNeeds) {
  const CampaignDirectory& directory = campaign_.directory();
  Database reader = campaign_.reader();
  const fs::path ended = directory.checkpoint(reader.points().at(0).hash, 0);
  const fs::path stray = directory.root() / "notes.txt";
  const fs::path foreign = directory.checkpoints() / "0000000000000000-000001.checkpoint";
  const fs::path unfinished = directory.spool() / "x.json.999999999.0.tmp";  // no process has this number
  const fs::path rejected = directory.rejected() / "x.json";
  const fs::path growing = growing_beside(ended);
  for (const fs::path& file : {ended, growing, stray, foreign, unfinished, rejected})
    std::ofstream(file) << "x";
  EXPECT_EQ(severity("checkpoint-left"), "note");
  EXPECT_EQ(severity("stray-file"), "note");
  EXPECT_EQ(severity("stray-checkpoint"), "note");
  EXPECT_EQ(severity("unfinished-file"), "note");
  EXPECT_EQ(severity("rejected-results"), "warning");
  EXPECT_EQ(examine(true).exit_code, 1);  // a person has to check the rejected one
  EXPECT_FALSE(fs::exists(ended));
  EXPECT_FALSE(fs::exists(growing));
  EXPECT_FALSE(fs::exists(unfinished));
  for (const fs::path& file : {stray, foreign, rejected}) EXPECT_TRUE(fs::exists(file)) << file;
}

// A killed run leaves checkpoints of seeds that ran ahead of what the point turned out to need.
TEST_F(Doctor, RemovesCheckpointsOfSeedsBeyondTheDecidingStopTestWhenAskedTo) {
  Database reader = campaign_.reader();
  const PointRecord point = reader.points().at(0);
  const int beyond = reader.campaign().target.maximum + 5;
  edit("INSERT INTO realisation (point_id, seed, state) VALUES (" + std::to_string(point.id) + ", " +
       std::to_string(beyond) + ", 'queued')");
  const fs::path extra = campaign_.directory().checkpoint(point.hash, beyond);
  std::ofstream(extra) << "x";
  EXPECT_EQ(severity("checkpoint-extra"), "note");
  EXPECT_EQ(severity("checkpoint-left"), "");
  EXPECT_EQ(examine().exit_code, 0);
  EXPECT_TRUE(fs::exists(extra));
  // The seed may be wanted once the point is no longer decided.
  edit("UPDATE stop_test SET verdict = 'more'");
  EXPECT_EQ(severity("checkpoint-extra"), "");
  edit("UPDATE stop_test SET verdict = 'converged'");
  EXPECT_EQ(examine(true).exit_code, 0) << examine().text;
  EXPECT_FALSE(fs::exists(extra));
}

TEST_F(Doctor, MissesABackupAndMakesIt) {
  fs::remove_all(campaign_.directory().backup());
  EXPECT_EQ(severity("no-backup"), "warning");
  EXPECT_EQ(examine(true).exit_code, 0);
  EXPECT_EQ(runner::examine(newest_backup(campaign_.directory().backup())).results,
            campaign_.count("SELECT count(*) FROM result"));
}

TEST_F(Doctor, FindsWorkersThatOutlivedTheirOwner) {
  EXPECT_EQ(severity("orphaned-worker"), "");
  EngineCommand command{"/bin/sleep", {"60"}, {}};
  command.environment = {"PECLET_CAMPAIGN=" + campaign_.directory().root().string(),
                         "PECLET_OWNER=999999999"};
  const EngineProcess orphan(command);
  EXPECT_EQ(severity("orphaned-worker"), "warning");
  EXPECT_NE(examine().text.find(std::to_string(orphan.process())), std::string::npos);
  orphan.kill();
}

TEST_F(Doctor, SeesThatTheDatabaseIsGone) {
  fs::remove(campaign_.directory().database());
  EXPECT_EQ(severity("database-gone"), "integrity");
  EXPECT_EQ(examine().exit_code, 6);
}

TEST_F(Doctor, RepairsNothingWhileAnOwnerRuns) {
  const OwnerLock lock(campaign_.directory());
  EXPECT_EQ(examine().exit_code, 0);
  EXPECT_THROW(examine(true), OwnedByAnother);
}

TEST(DoctorOfARunningCampaign, IsNotAlarmed) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7, {{"PECLET_FAKE_STEP_MS", "5"}}));
  campaign.wait_for_results(2);
  DoctorOptions options;
  options.campaign = campaign.directory().root();
  options.json = true;
  // The run makes its first backup after ten minutes.
  const Json report = Json::parse(examine_campaign(options).text);
  for (const Json& finding : report.at("findings")) {
    EXPECT_EQ(finding.at("code"), "no-backup") << finding.dump();
  }
  campaign.release();
  EXPECT_EQ(campaign.finish(), 0) << campaign.log();
}

TEST(DoctorOfAKilledCampaign, QueuesWhatWasLeftRunning) {
  CampaignOnDisk campaign;
  campaign.start(campaign.held_from(7, {{"PECLET_FAKE_STEP_MS", "5"}}));
  campaign.wait_for_results(2);
  campaign.signal(SIGKILL);
  campaign.finish();
  DoctorOptions options;
  options.campaign = campaign.directory().root();
  EXPECT_NE(examine_campaign(options).text.find("left running"), std::string::npos);
  options.repair = true;
  examine_campaign(options);
  EXPECT_EQ(campaign.count("SELECT count(*) FROM realisation WHERE state = 'running'"), 0);
}

}  // namespace
}  // namespace peclet::runner
