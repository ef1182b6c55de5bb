// A dispatcher with a scripted pool of two workers and a real database.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "runner/owner/dispatcher.h"
#include "runner/store/point_store.h"
#include "tests/runner/owner/scripted_pool.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

// Values for one point at 5 %: with 10 and 10.01 in turn, four seeds decide it at the first stop test.
inline double steady(int seed) { return seed % 2 == 0 ? 10 : 10.01; }

class Dispatching : public testing::Test {
 protected:
  Dispatching() {
    create_folders(directory_);
    PointStore(database_).adopt(campaign_);
  }

  Dispatcher::Ending run() {
    state_.emplace(database_, campaign_, directory_, listener_, 2);
    Dispatcher dispatcher(database_, *state_, pool_, listener_, settings_, [this] { return pool_.now; });
    return dispatcher.run();
  }

  void finish_all() {
    for (int worker = 0; worker < pool_.size(); ++worker) {
      if (pool_.has_job(worker)) pool_.finish(worker, steady(pool_.job(worker).seed));
    }
  }
  std::vector<AttemptRecord> attempts_of(int seed) {
    std::vector<AttemptRecord> found;
    for (const AttemptRecord& record : database_.attempts(1)) {
      if (record.seed == seed) found.push_back(record);
    }
    return found;
  }
  SeedState state_of(int seed) { return database_.realisations(1).at(static_cast<std::size_t>(seed)).state; }
  bool was_warned_of(const std::string& text) const {
    return std::any_of(listener_.warnings.begin(), listener_.warnings.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
  }

  TemporaryFolder folder_;
  CampaignDirectory directory_{folder_.path()};
  Campaign campaign_ = plain_campaign(1, 4, 40, 0.05);
  Database database_ = Database::open_owner(directory_.database());
  ScriptedPool pool_{2};
  SilentListener listener_;
  DispatchSettings settings_{};
  std::optional<CampaignState> state_;
};

}  // namespace peclet::runner
