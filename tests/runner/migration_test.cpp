#include "runner/migration.h"

#include <gtest/gtest.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "runner/queue.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

class Migration : public testing::Test {
 protected:
  Migration() {
    Connection(path().string(), Connection::Access::create, 0)
        .execute(read_file(PECLET_SOURCE_DIR "/tests/runner/campaign-version-1.sql"));
  }
  std::filesystem::path path() const { return folder_.path() / "campaign.db"; }
  std::filesystem::path kept() const { return folder_.path() / "campaign.db.version-1"; }
  TemporaryFolder folder_;
};

// Table, column, type, NOT NULL, default and place in the key of every column, views included.
std::string layout(Connection& connection) {
  return connection.text(
      "SELECT group_concat(line, char(10)) FROM (SELECT t.name || ' ' || c.cid || ' ' || c.name || ' ' || "
      "c.type"
      " || ' ' || c.\"notnull\" || ' ' || coalesce(c.dflt_value, '-') || ' ' || c.pk AS line FROM"
      " pragma_table_list t, pragma_table_info(t.name) c WHERE t.schema = 'main' ORDER BY t.name, c.cid)");
}

TEST_F(Migration, LeavesTheTablesThatANewCampaignHas) {
  Database old = Database::open_owner(path());
  Database fresh = Database::open_owner(folder_.path() / "fresh.db");
  EXPECT_EQ(old.connection().integer("PRAGMA user_version"), 2);
  EXPECT_EQ(layout(old.connection()), layout(fresh.connection()));
  EXPECT_EQ(old.connection().text("PRAGMA integrity_check"), "ok");
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
