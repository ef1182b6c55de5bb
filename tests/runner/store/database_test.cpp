#include "runner/store/database.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/store/backups.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "tests/runner/runner_fixture.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

class Databases : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_.path() / "campaign.db"; }
  TemporaryFolder folder_;
};

TEST_F(Databases, IsDurableStrictAndOurs) {
  Database database = Database::open_owner(path());
  Connection& connection = database.connection();
  EXPECT_EQ(connection.text("PRAGMA journal_mode"), "wal");
  EXPECT_EQ(connection.integer("PRAGMA synchronous"), 2);  // FULL
  EXPECT_EQ(connection.integer("PRAGMA foreign_keys"), 1);
  EXPECT_EQ(connection.integer("PRAGMA user_version"), 1);
  EXPECT_EQ(connection.integer("PRAGMA application_id"), 0x50434c4c);  // "PCLL"
  EXPECT_EQ(connection.integer("PRAGMA page_size"), 16384);
  EXPECT_EQ(connection.integer(
                "SELECT count(*) FROM pragma_table_list WHERE type = 'table' AND schema = 'main' AND "
                "name NOT LIKE 'sqlite_%' AND NOT strict"),
            0);
}

TEST_F(Databases, AFileThatIsNoDatabaseIsLeftAlone) {
  const std::string text(5000, 'x');
  std::ofstream(path()) << text;
  EXPECT_THROW(Database::open_owner(path()), IntegrityError);
  EXPECT_THROW(Database::open_reader(path()), IntegrityError);
  std::ifstream file(path());
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
}

TEST_F(Databases, SomebodyElsesDatabaseIsLeftAlone) {
  Connection(path().string(), Connection::Access::create, 0).execute("CREATE TABLE music (title TEXT)");
  EXPECT_THROW(Database::open_owner(path()), IntegrityError);
  EXPECT_THROW(Database::open_reader(path()), IntegrityError);
}

TEST_F(Databases, AnotherVersionAsksForTheProgramThatWroteIt) {
  for (const std::string version : {"0", "2", "7"}) {
    Database::open_owner(path()).connection().execute("PRAGMA user_version = " + version);
    for (const bool owner : {true, false}) {
      try {
        owner ? Database::open_owner(path()) : Database::open_reader(path());
        FAIL() << "opened";
      } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find(path().string()), std::string::npos) << text;
        EXPECT_NE(text.find("of version " + version + ", and this program knows version 1"),
                  std::string::npos)
            << text;
      }
    }
    for (const char* const suffix : {"", "-wal", "-shm"}) std::filesystem::remove(path().string() + suffix);
  }
}

TEST_F(Databases, HoldNoSeedThatACampaignCannotHave) {
  Database database = Database::open_owner(path());
  database.connection().execute(
      "INSERT INTO point (point_id, hash, scene, settings, label) VALUES (1, 'a', '{}', '{}', 'a')");
  const std::string insert = "INSERT INTO realisation (point_id, seed, state) VALUES (1, ";
  for (const int seed : {0, most_realisations - 1})
    database.connection().execute(insert + std::to_string(seed) + ", 'queued')");
  for (const int seed : {-1, most_realisations})
    EXPECT_THROW(database.connection().execute(insert + std::to_string(seed) + ", 'queued')"), DatabaseError);
}

TEST_F(Databases, DamageIsFoundWhenTheOwnerOpens) {
  {
    Database database = Database::open_owner(path());
    PointStore(database).adopt(plain_campaign(200, 4, 40, 0.05));
  }
  {
    std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(12288);  // the fourth page
    file << std::string(8192, '\xff');
  }
  EXPECT_THROW(Database::open_owner(path()), IntegrityError);
}

// Such a file may be made to let a reader wait for ever, or a writer write something else.
TEST_F(Databases, TablesThatThisProgramDidNotMakeAreNotRead) {
  const char* const changes[] = {
      R"(ALTER TABLE point RENAME TO real_point;
         CREATE VIEW point AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)
         SELECT i AS point_id, i AS place FROM n)",
      "CREATE TRIGGER more AFTER INSERT ON event BEGIN UPDATE realisation SET cause = 'x'; END",
      "ALTER TABLE stop_test ADD COLUMN more INTEGER",
      "ALTER TABLE stop_test ADD COLUMN more BLOB AS (zeroblob(1000000000))",
      "DROP VIEW estimates; DROP TABLE stop_test",
      "DROP TABLE prediction; CREATE VIRTUAL TABLE prediction USING fts5(point_id)",
  };
  for (const char* const change : changes) {
    Database::open_owner(path()).connection().execute(
        std::string("PRAGMA foreign_keys = OFF; PRAGMA legacy_alter_table = ON; ") + change);
    for (const bool owner : {true, false}) {
      try {
        owner ? Database::open_owner(path()) : Database::open_reader(path());
        FAIL() << "opened after " << change;
      } catch (const IntegrityError& error) {
        EXPECT_NE(std::string(error.what()).find("another program made or changed this file"),
                  std::string::npos)
            << error.what();
      }
    }
    for (const char* const suffix : {"", "-wal", "-shm"}) std::filesystem::remove(path().string() + suffix);
  }
}

// Otherwise SQLite's own error about references to a view would hide what is wrong.
TEST_F(Databases, AViewInThePlaceOfATableIsDamage) {
  Database database = Database::open_owner(path());
  Connection& connection = database.connection();
  connection.execute(
      "PRAGMA foreign_keys = OFF; PRAGMA legacy_alter_table = ON; ALTER TABLE point RENAME TO real_point; "
      "CREATE VIEW point AS SELECT * FROM real_point");
  EXPECT_NE(damage(connection).find("point is not the table"), std::string::npos) << damage(connection);
}

TEST_F(Databases, ViewsOfPeopleDoNoHarm) {
  Database owner = Database::open_owner(path());
  PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  owner.connection().execute("CREATE VIEW mine AS SELECT label FROM point");
  EXPECT_EQ(Database::open_reader(path()).points().size(), 1U);
}

// SQLite cannot begin its log anew while a reader uses an earlier state.
TEST_F(Databases, TheLogShrinksWhenAReaderThatHeldItUpHasGone) {
  Database owner = Database::open_owner(path());
  PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  const auto write = [&owner](std::size_t bytes) {
    Statement(owner.connection(), "INSERT INTO event (at, kind, message) VALUES ('now', 'test', ?)")
        .bind(noise(bytes))
        .run();
  };
  const auto log_size = [this] { return std::filesystem::file_size(path().string() + "-wal"); };
  write(1);
  {
    Database reader = Database::open_reader(path());
    reader.events(1);
    for (int i = 0; i < 24; ++i) write(1 << 20);
    EXPECT_GT(log_size(), 24U << 20);
  }
  for (int i = 0; i < 3; ++i) write(1);
  EXPECT_LE(log_size(), 8U << 20);
}

TEST_F(Databases, AReaderOfWhatIsOnlyJustBeingSetUpMayWait) {
  std::ofstream(path()) << "";
  EXPECT_THROW(Database::open_reader(path()), BeingSetUp);
  Database owner = Database::open_owner(path());  // tables without a campaign
  EXPECT_THROW(Database::open_reader(path()), BeingSetUp);
  PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  EXPECT_NO_THROW(Database::open_reader(path()));
}

// This is so for a colleague's campaign. Root may write anywhere and becomes another user meanwhile.
TEST_F(Databases, AReaderNeedsNoRightToWrite) {
  {
    Database owner = Database::open_owner(path());
    PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  }
  ASSERT_FALSE(std::filesystem::exists(path().string() + "-wal"));
  constexpr uid_t nobody = 65534;
  const uid_t self = geteuid();
  const auto as_stranger = [&](const auto& what) {
    std::filesystem::permissions(path().parent_path(), std::filesystem::perms(0555));
    ASSERT_EQ(seteuid(self == 0 ? nobody : self), 0);
    what();
    ASSERT_EQ(seteuid(self), 0);
    std::filesystem::permissions(path().parent_path(), std::filesystem::perms(0755));
  };
  EXPECT_FALSE(is_frozen_for_us(path()));
  as_stranger([&] {
    EXPECT_TRUE(is_frozen_for_us(path()));
    EXPECT_EQ(Database::open_reader(path()).points().size(), 1U);
  });
  // A log cannot be read without an index of it, which a reader without rights cannot write.
  std::ofstream(path().string() + "-wal") << std::string(4152, 'x');
  as_stranger([&] {
    try {
      Database::open_reader(path());
      ADD_FAILURE() << "opened";
    } catch (const InputError& error) {
      EXPECT_TRUE(says(error.what(), "has a log beside it")) << error.what();
    }
  });
}

// Each worker has an engine of its own, hence another process.
TEST_F(Databases, CountsTheWorkersOfTheLastRun) {
  StoredCampaign campaign(1, 4, 20);
  EXPECT_EQ(campaign.database().last_workers(), 0);
  campaign.complete(0, 0, 10);
  campaign.begin(0, 1);
  campaign.begin(0, 2);
  Connection& connection = campaign.database().connection();
  connection.execute(
      "UPDATE attempt SET process = 4710 + attempt_id, worker = attempt_id - 1, "
      "started_at = '2026-01-01T00:00:00Z'");
  connection.execute("UPDATE attempt SET ended_at = '2026-01-01T00:00:09Z' WHERE attempt_id = 1");
  EXPECT_EQ(campaign.database().last_workers(), 3);
  // Attempts of an earlier run, and of another machine, do not count.
  connection.execute("UPDATE attempt SET started_at = '2026-01-02T00:00:00Z' WHERE attempt_id > 1");
  EXPECT_EQ(campaign.database().last_workers(), 2);
  connection.execute("UPDATE attempt SET host = 'other' WHERE attempt_id = 2");
  EXPECT_EQ(campaign.database().last_workers(), 1);
}

TEST_F(Databases, AReaderCannotWrite) {
  Database owner = Database::open_owner(path());
  PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  Database reader = Database::open_reader(path());
  EXPECT_THROW(reader.connection().execute("DELETE FROM point"), DatabaseError);
}

TEST_F(Databases, AReaderOfNothingIsToldHowToStart) {
  EXPECT_THROW(Database::open_reader(path()), InputError);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(Databases, AReaderSeesOneMomentWhileTheOwnerGoesOn) {
  Database owner = Database::open_owner(path());
  const Campaign campaign = plain_campaign(1, 4, 40, 0.05);
  PointStore(owner).adopt(campaign);
  Database reader = Database::open_reader(path());
  const std::int64_t point = reader.points().at(0).id;
  EXPECT_EQ(reader.counts(point).done, 0);
  ResultStore(owner).store(parse_result(plain_result(campaign.points[0].hash, 0, 11).dump()),
                           campaign.target);
  EXPECT_EQ(reader.counts(point).done, 0);
  EXPECT_EQ(Database::open_reader(path()).counts(point).done, 1);
}

TEST_F(Databases, ABusyDatabaseIsAnErrorAndNotSilence) {
  Database owner = Database::open_owner(path());
  const Transaction held(owner.connection());
  Connection second(path().string(), Connection::Access::read_write, 0);
  EXPECT_THROW(Transaction{second}, DatabaseError);
}

TEST_F(Databases, AnUncommittedTransactionLeavesNothing) {
  Database owner = Database::open_owner(path());
  try {
    const Transaction doomed(owner.connection());
    owner.connection().execute("INSERT INTO event (at, kind, message) VALUES ('now', 'test', 'lost')");
    throw std::runtime_error("something else goes wrong");
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(owner.events(10).empty());
}

TEST_F(Databases, NumbersThatDoNotExistAreNull) {
  Database owner = Database::open_owner(path());
  PointStore(owner).adopt(plain_campaign(1, 4, 40, 0.05));
  StopTest stop_test;
  stop_test.seeds = 4;
  stop_test.lost = 3;
  stop_test.estimate = {1, 12, std::nan("")};
  stop_test.half_width = std::nan("");
  stop_test.controlled = stop_test.estimate;
  stop_test.controlled_half_width = std::nan("");
  stop_test.verdict = Verdict::more;
  ResultStore(owner).store_stop_tests(1, {stop_test});
  EXPECT_EQ(
      owner.connection().integer("SELECT half_width IS NULL AND plain_half_width IS NULL FROM estimates"), 1);
  ASSERT_EQ(owner.stop_tests(1).size(), 1U);
  EXPECT_TRUE(std::isnan(owner.stop_tests(1)[0].stop_test.half_width));
  EXPECT_EQ(owner.stop_tests(1)[0].stop_test.estimate.mean, 12);
}

}  // namespace
}  // namespace peclet::runner
