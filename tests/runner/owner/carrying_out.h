// A campaign of two points whose owner carries out requests without processes.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

#include "contract/durable_file.h"
#include "runner/owner/request_handler.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

class CarryingOut : public testing::Test {
 protected:
  CarryingOut() {
    create_folders(directory_);
    document_ = {{"name", "small"},
                 {"scene", {{"fluid", {{"viscosity", 1}}}}},
                 {"sweep", {{{"set", "/peclet"}, {"values", {1, 10}}}}},
                 {"target", {{"relative_tolerance", 0.05}}},
                 {"realisations", {{"minimum", 8}, {"maximum", 40}}}};
    write();
    PointStore(database_).adopt(read_campaign(file()));
    begin();
  }

  std::filesystem::path file() const { return folder_.path() / "small.json"; }
  void write() const { write_durably(file(), document_.dump(2)); }
  // Starts an owner.
  void begin() {
    state_.emplace(database_, read_campaign(file()), directory_, listener_, 2);
    requests_.emplace(database_, *state_, directory_, listener_);
  }
  TakeOver file_as_it_is() const { return {file(), hash_of(read_campaign(file()))}; }

  // Returns the answer: "cancel: no more seeds: peclet=1".
  std::string ask(const Wish& wish) {
    const Request request = write_request(directory_, wish);
    requests_->carry_out();
    EXPECT_FALSE(std::filesystem::exists(request_file(directory_, request.name)));
    return answer(request);
  }
  std::string answer(const Request& request) {
    const std::optional<EventRecord> event = database_.event_of(request.name);
    return event ? event->kind + ": " + event->message : "";
  }
  std::int64_t count(const std::string& what) {
    return database_.connection().integer("SELECT count(*) FROM " + what);
  }
  std::int64_t id(int place) { return database_.points().at(static_cast<std::size_t>(place)).id; }
  std::string hash(int place) { return database_.points().at(static_cast<std::size_t>(place)).hash; }

  void store(int place, int seed, double viscosity, const std::string& engine = "engine") {
    ResultStore(database_).store(parse_result(plain_result(hash(place), seed, viscosity, engine).dump()),
                                 database_.campaign().target.target);
  }
  void crash_three_times(int place, int seed) {
    for (int i = 0; i < 3; ++i) {
      const std::int64_t attempt =
          SeedStore(database_).begin_attempt(id(place), seed, 0, 4711, engine_row(database_, plain_engine()));
      SeedStore(database_).end_attempt(attempt, {AttemptOutcome::crashed, 5});
    }
    SeedStore(database_).quarantine(id(place), seed, "crashed");
  }
  void blow_up(int place, int seed) {
    Json result = plain_result(hash(place), seed, 0);
    result["ending"]["cause"] = "overlap";
    result["mean"] = result["blocks"] = nullptr;
    ResultStore(database_).store(parse_result(result.dump()), database_.campaign().target.target);
  }

  TemporaryFolder folder_;
  CampaignDirectory directory_{folder_.path() / "small.peclet"};
  Json document_;
  Database database_ = [this] {
    create_folders(directory_);
    return Database::open_owner(directory_.database());
  }();
  SilentListener listener_;
  std::optional<CampaignState> state_;
  std::optional<RequestHandler> requests_;
};

}  // namespace peclet::runner
