#include "tests/runner/stored_campaign.h"

#include <algorithm>

#include "runner/store/database_summary.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

StoredCampaign::StoredCampaign(int points, int minimum, int maximum, const std::vector<Criterion>& also)
    : campaign_(plain_campaign(points, minimum, maximum, 0.05)),
      database_(Database::open_owner(CampaignDirectory(folder_.path()).database())) {
  campaign_.target.also = also;
  PointStore(database_).adopt(campaign_);
}

StoredCampaign::StoredCampaign(const Campaign& campaign)
    : campaign_(campaign), database_(Database::open_owner(CampaignDirectory(folder_.path()).database())) {
  PointStore(database_).adopt(campaign_);
}

void StoredCampaign::store(int point, const Json& result) {
  Transaction booking(database_.connection());
  const std::int64_t engine = engine_row(database_, plain_engine());
  const std::int64_t attempt =
      SeedStore(database_).begin_attempt(id(point), result["seed"].get<int>(), 1, 4711, engine);
  ResultStore(database_).store(parse_result(result.dump()), campaign_.target);
  SeedStore(database_).end_attempt(attempt, {AttemptOutcome::result, 100});
  store_stop_tests(point);
  booking.commit();
}

void StoredCampaign::store_stop_tests(int point) {
  StopTestCheck check(database_);
  for (const PointRecord& record : database_.points()) {
    // The stop tests of a curve are made together.
    if (*record.place == point || !campaign_.curves.empty())
      ResultStore(database_).store_stop_tests(record.id, check.replayed(record));
  }
}

void StoredCampaign::set_tolerance(double tolerance) {
  Target target = campaign_.target;
  target.tolerance = tolerance;
  set_target(target);
}

void StoredCampaign::set_target(const Target& target) {
  campaign_.target = target;
  PointStore(database_).adopt(campaign_);
  Transaction booking(database_.connection());
  for (int point = 0; point < static_cast<int>(campaign_.points.size()); ++point) store_stop_tests(point);
  booking.commit();
}

void StoredCampaign::complete(int point, int seed, double viscosity, const Json& warnings) {
  complete_with(point, seed, viscosity, [&](Json& result) { result["warnings"] = warnings; });
}

void StoredCampaign::complete_with(int point, int seed, double viscosity,
                                   const std::function<void(Json&)>& change) {
  Json result = plain_result(campaign_.points.at(static_cast<std::size_t>(point)).hash, seed, viscosity);
  change(result);
  store(point, result);
}

void StoredCampaign::complete_in_halves(int point, int seed, double first, double second) {
  Json result =
      plain_result(campaign_.points.at(static_cast<std::size_t>(point)).hash, seed, (first + second) / 2);
  result["mean"]["control_variates"]["brownian_pairwise"] = nullptr;
  std::vector<double> blocks(32, first);
  std::fill(blocks.begin() + 16, blocks.end(), second);
  result["blocks"] = {{"relative_viscosity", blocks}};
  store(point, result);
}

void StoredCampaign::repeat(int point, int seed, double viscosity) {
  const std::string& hash = campaign_.points.at(static_cast<std::size_t>(point)).hash;
  ResultStore(database_).store(parse_result(plain_result(hash, seed, viscosity).dump()), campaign_.target);
}

void StoredCampaign::blow_up(int point, int seed, const std::string& cause) {
  Json result = plain_result(campaign_.points.at(static_cast<std::size_t>(point)).hash, seed, 0);
  result["ending"] = {{"cause", cause}, {"step", 50}, {"message", "too near"}, {"state", "/somewhere"}};
  result["mean"] = result["blocks"] = nullptr;
  store(point, result);
}

void StoredCampaign::begin(int point, int seed) {
  Transaction booking(database_.connection());
  SeedStore(database_).begin_attempt(id(point), seed, 0, 4711, engine_row(database_, plain_engine()));
  booking.commit();
}

void StoredCampaign::crash(int point, int seed) {
  Transaction booking(database_.connection());
  const std::int64_t attempt =
      SeedStore(database_).begin_attempt(id(point), seed, 1, 4711, engine_row(database_, plain_engine()));
  SeedStore(database_).end_attempt(attempt,
                                   {AttemptOutcome::crashed, 42, {}, "signal 11 (Segmentation fault)"});
  SeedStore(database_).quarantine(id(point), seed, "crashed");
  store_stop_tests(point);
  booking.commit();
}

}  // namespace peclet::runner
