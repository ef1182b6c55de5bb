// A campaign that continues with another engine: what is set aside, and what is taken up again.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "runner/reports/explain.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"
#include "tests/runner/owner/carrying_out.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

TEST_F(CarryingOut, AnEngineThatIsAcceptedStartsAfreshBesideTheOld) {
  for (int seed = 0; seed < 3; ++seed) store(0, seed, 10, "old");
  for (int seed = 0; seed < 8; ++seed) store(1, seed, seed % 2 == 0 ? 10 : 10.5, "old");
  PointStore(database_).set_priority(id(0), 4);
  begin();
  EXPECT_THROW(state_->admit_engine(plain_engine("new")), OtherEngine);
  write_durably(directory_.checkpoint(hash(0), 5), "of the old engine");
  write_durably(growing_beside(directory_.checkpoint(hash(0), 5)), "of the old engine");
  const std::int64_t old_row = id(0);
  EXPECT_EQ(state_->accept_engine(engine_identity(plain_engine("new"))), 1);
  state_->admit_engine(plain_engine("new"));
  EXPECT_NE(id(0), old_row);
  EXPECT_EQ(database_.points().at(0).priority, 4);
  EXPECT_EQ(state_->scheduler().begun(0), 0);
  EXPECT_TRUE(state_->scheduler().decided(1));  // decided points stay as they are
  EXPECT_FALSE(fs::exists(directory_.checkpoint(hash(0), 5)));
  EXPECT_FALSE(fs::exists(growing_beside(directory_.checkpoint(hash(0), 5))));
  const std::vector<SetAside> kept = database_.set_aside(hash(0));
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].results, 3);
  EXPECT_EQ(kept[0].engine, engine_identity(plain_engine("old")));
  EXPECT_EQ(count("event WHERE kind = 'engine-accepted'"), 1);
  // Every report of the point tells of the results that were set aside.
  const std::string results = "3 results of engine " + kept[0].engine;
  const CampaignStatus status = read_status(database_);
  EXPECT_NE(status_table(status).find("peclet=1: " + results + " are set aside"), std::string::npos);
  EXPECT_EQ(status_json(status)["points"][0]["set_aside"][0]["results"], 3);
  EXPECT_NE(explain(database_, directory_, "peclet=1").find("set aside: " + results), std::string::npos);
  EXPECT_EQ(Json::parse(export_json(database_, false))["points"][0]["set_aside"][0]["engine"],
            kept[0].engine);
  EXPECT_FALSE(Json::parse(export_json(database_, true))["points"][0].contains("set_aside"));
}

TEST_F(CarryingOut, LateResultsOfTheOldEngineGoToItsOwnRow) {
  store(0, 0, 10, "old");
  begin();
  state_->accept_engine(engine_identity(plain_engine("new")));
  write_durably(directory_.spool_file(hash(0), 1, 3), plain_result(hash(0), 1, 11, "old").dump());
  write_durably(directory_.spool_file(hash(0), 2, 4), plain_result(hash(0), 2, 12, "new").dump());
  state_->ingest_spool();
  EXPECT_TRUE(fs::is_empty(directory_.rejected()));
  EXPECT_EQ(state_->scheduler().begun(0), 1);
  EXPECT_EQ(database_.outcomes(id(0)).at(2)->value, 12);
  EXPECT_EQ(database_.set_aside(hash(0)).at(0).results, 2);
  begin();
  EXPECT_EQ(state_->scheduler().begun(0), 1);
  // The result comes once more, while the new engine runs that seed.
  write_durably(directory_.checkpoint(hash(0), 1), "of the new engine");
  const fs::path again = directory_.spool_file(hash(0), 1, 5);
  write_durably(again, plain_result(hash(0), 1, 11, "old").dump());
  state_->ingest_spool();
  EXPECT_FALSE(fs::exists(again));
  EXPECT_TRUE(fs::exists(directory_.checkpoint(hash(0), 1)));
}

TEST_F(CarryingOut, AnEngineThatWasReplacedIsRefusedEvenBeforeTheFirstResultOfTheOther) {
  store(0, 0, 10, "old");
  begin();
  state_->accept_engine(engine_identity(plain_engine("new")));
  begin();
  EXPECT_THROW(state_->admit_engine(plain_engine("old")), OtherEngine);
  state_->admit_engine(plain_engine("new"));
}

TEST_F(CarryingOut, AnEngineThatComesBackGoesOnWithWhatItHad) {
  for (int seed = 0; seed < 3; ++seed) store(0, seed, 10, "old");
  begin();
  const std::int64_t old_row = id(0);
  state_->accept_engine(engine_identity(plain_engine("new")));
  store(0, 0, 10, "new");
  begin();
  state_->accept_engine(engine_identity(plain_engine("old")));
  EXPECT_EQ(id(0), old_row);
  EXPECT_EQ(state_->scheduler().begun(0), 3);
  EXPECT_EQ(database_.set_aside(hash(0)).at(0).engine, engine_identity(plain_engine("new")));
}

}  // namespace
}  // namespace peclet::runner
