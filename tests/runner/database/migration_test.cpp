#include "runner/database/migration.h"

#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "runner/database/campaign_sql.h"
#include "runner/database/checked_look.h"
#include "runner/database/number_book.h"
#include "runner/reports/export.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

// A database of version 1, from a campaign that was run with it.
class Migration : public testing::Test {
 protected:
  Migration() {
    Connection(path().string(), Connection::Access::create, 0)
        .execute(read_file(PECLET_SOURCE_DIR "/tests/runner/database/campaign-version-1.sql"));
  }
  std::filesystem::path path() const { return folder_.path() / "campaign.db"; }
  std::filesystem::path kept() const { return folder_.path() / "campaign.db.version-1"; }
  TemporaryFolder folder_;
};

// The same of version 2, with what only that had: a point that left the sweep, priorities, seeds handed over,
// events.
class MigrationFromVersion2 : public Migration {
 protected:
  MigrationFromVersion2() {
    Connection connection(path().string(), Connection::Access::read_write, 0);
    connection.execute("DROP VIEW points; DROP VIEW realisations; DROP VIEW estimates");
    connection.execute(version_2_sql);
    connection.execute(
        "INSERT INTO point (point_id, hash, scene, settings, label, priority, cancelled)"
        " VALUES (7, 'b0b0', '{}', '{}', 'gone', -3, 1);"
        "INSERT INTO realisation (point_id, seed, state) VALUES (7, 5, 'queued');"
        "INSERT INTO bundle (bundle_id, name, shared, tasks, made_at) VALUES (1, 'b', '/s', 1, 'now');"
        "INSERT INTO bundle_seed (bundle_id, place, task, point_id, seed) VALUES (1, 0, 1, 7, 5);"
        "INSERT INTO event (at, kind, point_id, seed, message) VALUES ('then', 'flag', 7, 5, 'overlap');");
    connection.execute(views_sql);
  }
};

// The same of version 5, as the released tables are, and as they were for a while between releases, when
// targets had the document already.
class MigrationFromVersion5 : public MigrationFromVersion2, public testing::WithParamInterface<bool> {
 protected:
  MigrationFromVersion5() {
    Connection connection(path().string(), Connection::Access::read_write, 0);
    connection.execute("PRAGMA foreign_keys = OFF");
    connection.execute("DROP VIEW points; DROP VIEW realisations; DROP VIEW estimates; DROP VIEW files");
    for (const char* const sql : {version_3_sql, version_4_sql, version_5_sql}) connection.execute(sql);
    if (GetParam()) {
      connection.execute(
          "CREATE TABLE other (target_id INTEGER PRIMARY KEY, observable TEXT NOT NULL, criterion TEXT NOT "
          "NULL "
          "CHECK (json_valid(criterion)), confidence REAL NOT NULL, minimum INTEGER NOT NULL, maximum "
          "INTEGER "
          "NOT NULL, rule INTEGER NOT NULL, UNIQUE (observable, criterion)) STRICT;"
          "INSERT INTO other SELECT target_id, observable, '{\"absolute_tolerance\":0.5}', confidence, "
          "minimum, "
          "maximum, rule FROM target; DROP TABLE target; ALTER TABLE other RENAME TO target");
    }
    connection.execute(views_sql);
  }
};

// Table, column, type, NOT NULL, default and place in the key of every column, views included.
std::string columns(Connection& connection) {
  return connection.text(
      "SELECT group_concat(line, char(10)) FROM (SELECT t.name || ' ' || c.cid || ' ' || c.name || ' ' || "
      "c.type"
      " || ' ' || c.\"notnull\" || ' ' || coalesce(c.dflt_value, '-') || ' ' || c.pk AS line FROM"
      " pragma_table_list t, pragma_table_info(t.name) c WHERE t.schema = 'main' ORDER BY t.name, c.cid)");
}

// Index, table, whether unique, whether partial, and columns, in order of the tables.
std::string indices(Connection& connection) {
  return connection.text(
      "SELECT group_concat(line, char(10)) FROM (SELECT t.name || ' ' || i.\"unique\" || ' ' || i.partial || "
      "' '"
      " || (SELECT group_concat(c.name) FROM pragma_index_info(i.name) c) AS line"
      " FROM pragma_table_list t, pragma_index_list(t.name) i WHERE t.schema = 'main' ORDER BY line)");
}

void expect_newest_layout(const std::filesystem::path& path) {
  Database old = Database::open_owner(path);
  Database fresh = Database::open_owner(path.parent_path() / "fresh.db");
  EXPECT_EQ(old.connection().integer("PRAGMA user_version"), 7);
  EXPECT_EQ(columns(old.connection()), columns(fresh.connection()));
  EXPECT_EQ(indices(old.connection()), indices(fresh.connection()));
  EXPECT_EQ(old.connection().text("PRAGMA integrity_check"), "ok");
  EXPECT_EQ(old.connection().integer("PRAGMA foreign_keys"), 1);
}

TEST_F(Migration, LeavesTheTablesThatANewCampaignHas) { expect_newest_layout(path()); }

TEST_F(MigrationFromVersion2, LeavesTheTablesThatANewCampaignHas) { expect_newest_layout(path()); }

TEST_P(MigrationFromVersion5, LeavesTheTablesThatANewCampaignHas) { expect_newest_layout(path()); }

TEST_P(MigrationFromVersion5, KeepsTheTolerance) {
  const double stored = 0.05;  // in campaign-version-1.sql
  const Target target = Database::open_owner(path()).campaign().target.target;
  EXPECT_EQ(target.tolerance, GetParam() ? Tolerance::absolute(0.5) : Tolerance(stored));
  EXPECT_TRUE(target.also.empty());
}

INSTANTIATE_TEST_SUITE_P(BothForms, MigrationFromVersion5, testing::Bool());

TEST_F(MigrationFromVersion2, KeepsEveryRowAndWhatRefersToIt) {
  Database database = Database::open_owner(path());
  EXPECT_EQ(database.outcomes(database.points().at(0).id).size(), 4U);
  const PointRecord gone = database.inactive_points().at(0);
  EXPECT_EQ(gone.id, 7);
  EXPECT_EQ(gone.hash, "b0b0");
  EXPECT_EQ(gone.priority, -3);
  EXPECT_TRUE(gone.cancelled);
  const auto count = [&](const char* what) {
    return database.connection().integer(std::string("SELECT count(*) FROM ") + what);
  };
  EXPECT_EQ(count("bundle_seed WHERE point_id = 7 AND seed = 5"), 1);
  EXPECT_EQ(count("event WHERE point_id = 7 AND request IS NULL"), 1);
  EXPECT_EQ(count("attempt WHERE pardoned = 0"), 4);
  EXPECT_EQ(count("point WHERE kept_apart = 0"), 2);
}

TEST_F(MigrationFromVersion2, OfADatabaseWithADanglingReferenceIsRefusedAndUndone) {
  {
    Connection connection(path().string(), Connection::Access::read_write, 0);
    connection.execute("PRAGMA foreign_keys = OFF; DELETE FROM point WHERE point_id = 7");
  }
  EXPECT_THROW(Database::open_owner(path()), IntegrityError);
  Connection connection(path().string(), Connection::Access::read_only, 0);
  EXPECT_EQ(connection.integer("PRAGMA user_version"), 2);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM points"), 1);
}

TEST_F(MigrationFromVersion2, LetsTwoEnginesResultsOfASceneStandSideBySide) {
  Database database = Database::open_owner(path());
  const std::string another =
      "INSERT INTO point (hash, scene, settings, label, engine_identity, kept_apart)"
      " SELECT hash, scene, settings, label, 'B', ";
  EXPECT_THROW(database.connection().execute(another + "0 FROM point WHERE place = 0"), DatabaseError);
  database.connection().execute(another + "1 FROM point WHERE place = 0");
  EXPECT_THROW(database.connection().execute(another + "1 FROM point WHERE place = 0"), DatabaseError);
}

TEST_F(Migration, KeepsWhatTheCampaignHadAndTakesWhatItLacked) {
  Database database = Database::open_owner(path());
  const PointRecord point = database.points().at(0);
  const std::vector<std::optional<Outcome>> outcomes = database.outcomes(point.id);
  ASSERT_EQ(outcomes.size(), 4U);
  EXPECT_EQ(outcomes[2]->kind, Outcome::Kind::lost);
  for (const int seed : {0, 1, 3}) {
    const Outcome& outcome = *outcomes[static_cast<std::size_t>(seed)];
    const Json result = database.result(point.id, seed).value();
    EXPECT_EQ(outcome.value, result["mean"]["relative_viscosity"].get<double>());
    EXPECT_NEAR(outcome.first_half, result["blocks"]["relative_viscosity"][0].get<double>(), 1e-12);
  }
  EXPECT_FALSE(database.looks(point.id).empty());
}

TEST_F(Migration, TakesTheNumbersOfEachResult) {
  Database database = Database::open_owner(path());
  const PointRecord point = database.points().at(0);
  NumberBook book(database.connection());
  for (const int seed : {0, 1, 3})
    EXPECT_TRUE(book.agrees(point.id, seed, database.result(point.id, seed).value()));
  // Of the result that ended early there are none.
  EXPECT_EQ(database.connection().integer("SELECT count(*) FROM numbers"), 3);
}

// The doctor is to find them.
TEST_P(MigrationFromVersion5, LeavesResultsThatCannotBeReadWithoutNumbers) {
  Connection(path().string(), Connection::Access::read_write, 0)
      .execute(
          "UPDATE result SET document = zeroblob(9) WHERE seed = 1; UPDATE result SET document = '{}' WHERE "
          "seed = 0");
  Database database = Database::open_owner(path());
  EXPECT_EQ(database.connection().integer("SELECT count(*) FROM numbers"), 1);
}

// Looks that an earlier rule made are read, checked and shown by it, until the campaign is run again.
TEST_F(Migration, LeavesLooksAndTheirRule) {
  Connection(path().string(), Connection::Access::read_write, 0)
      .execute(
          "UPDATE look SET mean = 1, standard_error = 2, half_width = 3, controlled_mean = 4, "
          "controlled_standard_error = 5, controlled_half_width = 6");
  Database database = Database::open_owner(path());
  const PointRecord point = database.points().at(0);
  const LookRecord look = database.looks(point.id).back();
  EXPECT_EQ(look.target.target.rule, Target::first_rule);
  EXPECT_EQ(look.look.controlled.mean, 4);
  EXPECT_EQ(look.look.controlled_half_width, 6);
  EXPECT_EQ(look.look.estimate.mean, 1);
  EXPECT_EQ(look.look.half_width, 3);
  const std::string columns =
      "SELECT mean || standard_error || half_width || uncontrolled_mean || "
      "uncontrolled_standard_error || uncontrolled_half_width FROM estimates";
  EXPECT_EQ(database.connection().text(columns), "4.05.06.01.02.03.0");
}

TEST_F(Migration, LeavesLooksThatTheStoredResultsConfirm) {
  Database database = Database::open_owner(path());
  const TargetRecord target = database.campaign().target;
  for (const PointRecord& point : database.points()) EXPECT_NO_THROW(checked_look(database, point, target));
}

TEST_F(Migration, KeepsACopyOfTheOldDatabase) {
  Database::open_owner(path());
  Connection copy(kept().string(), Connection::Access::read_only, 0);
  EXPECT_EQ(copy.integer("PRAGMA user_version"), 1);
  EXPECT_EQ(copy.text("PRAGMA integrity_check"), "ok");
  EXPECT_EQ(copy.integer("SELECT count(*) FROM result"), 4);
}

TEST_F(Migration, ThatWasCutShortIsDoneAgain) {
  std::ofstream(kept().string() + ".tmp") << "half of a copy";
  Database::open_owner(path());
  EXPECT_EQ(Connection(kept().string(), Connection::Access::read_only, 0).integer("PRAGMA user_version"), 1);
  Database::open_owner(path());
  EXPECT_EQ(Connection(kept().string(), Connection::Access::read_only, 0).integer("PRAGMA user_version"), 1);
}

TEST_F(Migration, IsLeftToTheOwner) {
  EXPECT_THROW(Database::open_reader(path()), InputError);
  EXPECT_FALSE(std::filesystem::exists(kept()));
}

}  // namespace
}  // namespace peclet::runner
