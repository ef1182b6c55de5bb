// StoredCampaign is a campaign whose database is filled by hand, for tests of its readers.
#pragma once

#include <functional>
#include <vector>

#include "runner/store/database.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

class StoredCampaign {
 public:
  // Stores plain_campaign() with a tolerance of 5 % and further targets.
  StoredCampaign(int points, int minimum, int maximum, const std::vector<Criterion>& also = {});
  explicit StoredCampaign(const Campaign& campaign);

  // Stores a result of plain_result(), with an attempt of its own, and the stop tests that follow.
  void complete(int point, int seed, double viscosity, const Json& warnings = Json::array());
  // Does as complete() after a change of the result.
  void complete_with(int point, int seed, double viscosity, const std::function<void(Json&)>& change);
  // Does as complete() with a window whose halves differ; the control variate is zero.
  void complete_in_halves(int point, int seed, double first, double second);
  // Does as `peclet set --tolerance`, with the stop tests that follow.
  void set_tolerance(double tolerance);
  // Does as a campaign file with another target, with the stop tests that follow.
  void set_target(const Target& target);
  // Offers one more result of a seed that has ended.
  void repeat(int point, int seed, double viscosity);
  void blow_up(int point, int seed, const std::string& cause = "overlap");
  // Gives the seed to a worker.
  void begin(int point, int seed);
  // Stores one attempt that crashed, after which the seed is given up.
  void crash(int point, int seed);

  Database& database() { return database_; }
  CampaignDirectory directory() const { return CampaignDirectory(folder_.path()); }

 private:
  void store(int point, const Json& result);
  void store_stop_tests(int point);
  std::int64_t id(int point) { return database_.points().at(static_cast<std::size_t>(point)).id; }

  TemporaryFolder folder_;
  Campaign campaign_;
  Database database_;
};

}  // namespace peclet::runner
