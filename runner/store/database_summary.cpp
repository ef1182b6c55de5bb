#include "runner/store/database_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "contract/errors.h"
#include "contract/frames.h"
#include "runner/statistics/curve_stop_tests.h"
#include "runner/statistics/window_advice.h"
#include "runner/store/number_store.h"
#include "runner/store/result_store.h"

namespace peclet::runner {
namespace {

struct Aggregate {
  StateCounts counts;
  RunningEstimate all_seeds;
  std::vector<int> ended;         // in order of the seeds
  std::vector<int> tested;        // first seeds with blocks, as many as a test for transients needs
  std::vector<double> seconds;    // processor time of each ended seed
  std::vector<int> jammed, lost;  // ended seeds that jammed, or have no value for another reason

  void count(SeedState state, int seed, const std::string& cause, double cpu_seconds) {
    ++counts.of(state);
    if (state == SeedState::queued || state == SeedState::running) return;
    if (is_jam(cause)) {
      jammed.push_back(seed);
    } else if (state != SeedState::done) {
      lost.push_back(seed);
    }
    ended.push_back(seed);
    seconds.push_back(cpu_seconds);
    counts.cpu_seconds += cpu_seconds;
  }
  double seconds_of_first(int count) const {
    return std::accumulate(seconds.begin(), seconds.begin() + count, 0.0);
  }
  int ended_below(int seed) const { return below(ended, seed); }
  Endings endings_below(int seed) const {
    return {below(ended, seed), below(jammed, seed), below(lost, seed)};
  }
  // True if the stop test had too few seeds with blocks for a test for transients.
  bool lacks_blocks_of(const StopTest& stop_test) const {
    return lacks_blocks(stop_test.estimate.count, below(tested, stop_test.seeds));
  }

 private:
  static int below(const std::vector<int>& seeds, int seed) {
    return static_cast<int>(std::lower_bound(seeds.begin(), seeds.end(), seed) - seeds.begin());
  }
};

// Reads the seeds in one pass in stored order, which takes most of the time of a large campaign.
std::map<std::int64_t, Aggregate> read_aggregates(Connection& connection) {
  Statement query(connection,
                  "SELECT point_id, seed, state, numbers, cpu_seconds, cause FROM realisation "
                  "LEFT JOIN numbers USING (point_id, seed) ORDER BY point_id, seed");
  std::map<std::int64_t, Aggregate> aggregates;
  while (query.step()) {
    Aggregate& aggregate = aggregates[query.integer(0)];
    const int seed = query.number(1);
    aggregate.count(seed_state(query.text(2)), seed, query.text(5), query.optional_real(4).value_or(0));
    const Observation observed = leading_observation(query.text(3));
    if (!observed.has_value()) continue;
    add(aggregate.all_seeds, observed);
    if (!std::isnan(observed.first_half) && aggregate.tested.size() < fewest_contrasts)
      aggregate.tested.push_back(seed);
  }
  return aggregates;
}

using CountsByPoint = std::map<std::int64_t, std::map<std::string, int>>;

// Counts the rows of a query of point, name and count.
CountsByPoint counts_by_point(Connection& connection, const char* sql) {
  Statement query(connection, sql);
  CountsByPoint counts;
  while (query.step()) counts[query.integer(0)][query.text(1)] = query.number(2);
  return counts;
}

// Returns what engines said of results without a value, and the last messages of attempts at given-up seeds,
// by point and cause. The first seed of each cause counts.
std::map<std::int64_t, std::map<std::string, std::string>> read_loss_reasons(Connection& connection) {
  Statement query(
      connection,
      "SELECT e.point_id, r.cause, e.seed, e.event_id, e.message FROM event e JOIN realisation r USING "
      "(point_id, seed) WHERE e.kind = 'lost' AND r.state = 'failed' UNION ALL "
      "SELECT a.point_id, r.cause, a.seed, -a.attempt_id, a.message FROM attempt a JOIN realisation r USING "
      "(point_id, seed) WHERE a.blamed = 1 AND a.pardoned = 0 AND r.state = 'quarantined' AND a.message != "
      "'' ORDER BY 1, 3, 4");
  std::map<std::int64_t, std::map<std::string, std::string>> reasons;
  while (query.step()) {
    reasons[query.integer(0)].emplace(query.text(1),
                                      fmt::format("{} (seed {})", query.text(4), query.integer(2)));
  }
  return reasons;
}

// Returns the largest number of seeds at a stop test for an earlier target, by point.
std::map<std::int64_t, int> read_largest_earlier_stop_tests(Connection& connection) {
  Statement query(connection,
                  "SELECT point_id, max(seeds) FROM stop_test WHERE target_id != (SELECT target_id FROM "
                  "campaign) GROUP BY "
                  "point_id");
  std::map<std::int64_t, int> largest;
  while (query.step()) largest[query.integer(0)] = query.number(1);
  return largest;
}

// Restores what is not stored of the last stop test. Outcomes are read only for one without an interval.
void make_again(Database& database, const PointRecord& point, const TargetRecord& target,
                PointSummary& summary) {
  if (summary.stop_tests.empty()) return;
  StopTest& stop_test = summary.stop_tests.back();
  stop_test.near_maximum = is_near_maximum(stop_test, target.target, target.maximum);
  summary.without_interval = without_interval(stop_test, target.target);
  if (summary.without_interval.empty()) return;
  const std::vector<std::optional<Outcome>> outcomes = database.outcomes(point.id);
  stop_test.repeated = repeated_seeds(
      std::span(outcomes).first(std::min(outcomes.size(), static_cast<std::size_t>(stop_test.seeds))));
}

// NaN stands for a number that is undefined or too large.
bool is_same(double one, double other) { return one == other || (std::isnan(one) && std::isnan(other)); }

// Another build may round the last digits of a band differently.
bool is_same_band(const std::optional<CurveBand>& one, const std::optional<CurveBand>& other) {
  constexpr double rounding = 1e-6;
  const auto is_near = [](double a, double b) {
    return is_same(a, b) || std::abs(a - b) <= rounding * std::abs(b);
  };
  if (!one || !other) return one.has_value() == other.has_value();
  return is_near(one->mean, other->mean) && is_near(one->low, other->low) &&
         is_near(one->high, other->high) && one->refused == other->refused;
}

// A point that waited for its curve may have been decided by results that no owner has booked yet.
bool agree(const std::vector<ObservableStopTest>& stored, const std::vector<ObservableStopTest>& replayed,
           bool is_waiting) {
  return std::equal(
      stored.begin(), stored.end(), replayed.begin(), replayed.end(),
      [=](const ObservableStopTest& one, const ObservableStopTest& other) {
        return one.observable == other.observable &&
               (is_waiting || (one.verdict == other.verdict && is_same_band(one.curve, other.curve))) &&
               one.estimate.count == other.estimate.count && is_same(one.estimate.mean, other.estimate.mean);
      });
}

bool agrees(const StopTest& stored, const StopTest& replayed) {
  const bool is_waiting = waits_for_curve(stored);
  return agree(stored.each, replayed.each, is_waiting) && stored.seeds == replayed.seeds &&
         stored.lost == replayed.lost && (stored.verdict == replayed.verdict || is_waiting) &&
         stored.estimate.count == replayed.estimate.count &&
         (stored.estimate.count == 0 || (is_same(stored.estimate.mean, replayed.estimate.mean) &&
                                         is_same(stored.controlled.mean, replayed.controlled.mean)));
}

}  // namespace

Json to_json(const Endings& endings) {
  return {{"ended", endings.ended},
          {"jammed", endings.jammed},
          {"lost", endings.lost},
          {"has_jammed", endings.has_jammed()}};
}

std::vector<PointSummary> summarise_points(Database& database, const TargetRecord& target) {
  Connection& connection = database.connection();
  std::map<std::int64_t, Aggregate> aggregates = read_aggregates(connection);
  std::map<std::int64_t, std::vector<StopTest>> stop_tests = database.stop_tests_by_point();
  CountsByPoint losses = counts_by_point(connection,
                                         "SELECT point_id, cause, count(*) FROM realisation WHERE state IN "
                                         "('failed', 'quarantined') GROUP BY point_id, cause");
  std::map<std::int64_t, std::map<std::string, std::string>> reasons = read_loss_reasons(connection);
  CountsByPoint flags = counts_by_point(connection,
                                        "SELECT point_id, message, count(DISTINCT seed) FROM event WHERE "
                                        "kind = 'flag' GROUP BY point_id, message");
  const bool any_set_aside = connection.integer("SELECT count(*) FROM point WHERE set_aside = 1") > 0;
  std::map<std::int64_t, int> earlier = read_largest_earlier_stop_tests(connection);
  const std::map<std::int64_t, StoredPrediction> predictions = database.predictions();
  const std::vector<int> schedule = stop_test_schedule(target.minimum, target.maximum);

  std::vector<PointSummary> summaries;
  for (PointRecord& point : database.points()) {
    PointSummary summary;
    Aggregate& aggregate = aggregates[point.id];
    summary.confidence = target.target.confidence;
    summary.counts = aggregate.counts;
    summary.all_seeds = aggregate.all_seeds.estimate();
    summary.losses = std::move(losses[point.id]);
    summary.loss_reasons = std::move(reasons[point.id]);
    summary.flags = std::move(flags[point.id]);
    summary.stop_tests = std::move(stop_tests[point.id]);
    if (!summary.stop_tests.empty() && summary.stop_tests.back().each.empty()) {
      summary.stop_tests.back().untested = aggregate.lacks_blocks_of(summary.stop_tests.back());
    }
    make_again(database, point, target, summary);
    const int seen = summary.stop_tests.empty() ? 0 : summary.stop_tests.back().seeds;
    summary.endings =
        aggregate.endings_below(summary.stop_tests.empty() ? std::numeric_limits<int>::max() : seen);
    summary.decided = !summary.stop_tests.empty() && summary.stop_tests.back().verdict != Verdict::more;
    if (target.target.has_tolerance() && summary.decided && earlier[point.id] > seen)
      summary.earlier_stop_test = earlier[point.id];
    summary.waits = !summary.stop_tests.empty() && waits_for_curve(summary.stop_tests.back());
    summary.wanted = summary.decided || summary.waits
                         ? seen
                         : *std::upper_bound(schedule.begin(), schedule.end() - 1, seen);
    if (const auto known = predictions.find(point.id); known != predictions.end()) {
      summary.prediction = known->second;
    }
    summary.wanted_ended = aggregate.ended_below(summary.wanted);
    summary.wanted_cpu_seconds = aggregate.seconds_of_first(summary.wanted_ended);
    if (summary.counts.running > 0) summary.leases = database.leases(point.id);
    if (any_set_aside) summary.set_aside = database.set_aside(point.hash);
    summary.point = std::move(point);
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

std::vector<PointForecast> forecasts_of(Database& database, const std::vector<PointSummary>& points) {
  Statement query(database.connection(),
                  "SELECT point_id, wall_seconds FROM realisation WHERE wall_seconds IS NOT NULL");
  std::map<std::int64_t, std::vector<double>> seconds;
  while (query.step()) seconds[query.integer(0)].push_back(query.real(1));
  std::map<std::int64_t, std::vector<Unfinished>> unfinished = database.unfinished();
  const std::size_t observables = database.campaign().target.target.observables().size();
  std::vector<PointForecast> forecasts;
  for (const PointSummary& summary : points) {
    const std::int64_t id = summary.point.id;
    // Equal values may come from a share, which only the outcomes show.
    const bool is_simple = observables == 1 && summary.all_seeds.values != Estimate::Values::equal;
    forecasts.push_back({Cost(std::move(seconds[id])),
                         is_simple || !summary.open() ? std::vector{summary.all_seeds}
                                                      : estimates_so_far(database.outcomes(id), observables),
                         summary.counts.terminal(), summary.counts.running, !summary.open(),
                         std::move(unfinished[id])});
  }
  return forecasts;
}

StopTestCheck::StopTestCheck(Database& database) : database_(database) {
  const CampaignRecord campaign = database.campaign();
  target_ = campaign.target;
  curves_ = curves_of(campaign.document, target_.target);
}

std::vector<StopTest> StopTestCheck::replayed(const PointRecord& point) {
  if (curves_.empty())
    return replay_stop_tests(database_.outcomes(point.id), target_.target, target_.minimum, target_.maximum);
  if (!of_curves_.contains(*point.place)) {
    const auto place = static_cast<std::size_t>(*point.place);
    const Curve& curve = *std::ranges::find_if(curves_, [&](const Curve& each) {
      return std::ranges::find(each.points, place) != each.points.end();
    });
    const std::vector<PointRecord> points = database_.points();
    std::vector<std::vector<std::optional<Outcome>>> outcomes;
    std::vector<CurveStopTests::Member> members;
    for (const std::size_t number : curve.points) outcomes.push_back(database_.outcomes(points[number].id));
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      members.push_back({&outcomes[i], points[curve.points[i]].cancelled});
    CurveStopTests made(curve, target_.target, target_.minimum, target_.maximum);
    made.advance(members);
    for (std::size_t i = 0; i < members.size(); ++i)
      of_curves_[static_cast<int>(curve.points[i])] = made.stop_tests(i);
  }
  return of_curves_.at(*point.place);
}

std::optional<StopTest> StopTestCheck::last(const PointRecord& point) {
  const std::vector<StopTestRecord> stored = database_.stop_tests(point.id);
  const std::vector<StopTest> replayed = this->replayed(point);
  // An owner that was killed after a result may have left fewer stop tests than the results allow.
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (i < replayed.size() && agrees(stored[i].stop_test, replayed[i])) continue;
    throw IntegrityError(fmt::format(
        "{}: the stored stop test at {} seeds of {} is not what the stored results say; see `peclet doctor`",
        database_.connection().path(), stored[i].stop_test.seeds, point.label));
  }
  if (stored.empty()) return std::nullopt;
  StopTest stop_test = stored.back().stop_test;
  const StopTest& made_again = replayed[stored.size() - 1];
  stop_test.untested = made_again.untested;
  stop_test.near_maximum = made_again.near_maximum && is_reached(stop_test.verdict);
  stop_test.repeated = made_again.repeated;
  return stop_test;
}

int unreadable_results(Database& database, std::int64_t point) {
  Statement stored(
      database.connection(),
      "SELECT document, text FROM result LEFT JOIN dictionary USING (point_id) WHERE point_id = ?", point);
  int unreadable = 0;
  while (stored.step()) {
    if (!was_deflated_with(stored.text(0), stored.text(1))) ++unreadable;
  }
  return unreadable;
}

std::string readable_result(Database& database, std::int64_t point, int seed) {
  try {
    return database.result_text(point, seed).value_or("");
  } catch (const IntegrityError&) {
    return database.connection().text("SELECT document FROM result WHERE point_id = ? AND seed = ?", point,
                                      seed);
  }
}

StateFaults state_faults(Database& database) {
  Connection& connection = database.connection();
  return {
      connection.integer("SELECT count(*) FROM result JOIN realisation USING (point_id, seed) WHERE state "
                         "NOT IN ('done', 'failed')"),
      connection.integer(
          "SELECT (SELECT count(*) FROM lease LEFT JOIN realisation USING (point_id, seed) WHERE state IS "
          "NOT 'running') + (SELECT count(*) FROM realisation LEFT JOIN lease USING (point_id, seed) WHERE "
          "state = 'running' AND attempt_id IS NULL)"),
      connection.integer("SELECT count(*) FROM realisation WHERE state = 'running'")};
}

ClockFaults clock_faults(Database& database, const std::string& now) {
  Connection& connection = database.connection();
  return {connection.integer(
              "SELECT count(*) FROM event a JOIN event b ON b.event_id = a.event_id + 1 WHERE b.at < a.at"),
          connection.integer("SELECT count(*) FROM attempt WHERE ended_at < started_at"),
          connection.integer(
              "SELECT (SELECT count(*) FROM event WHERE at > ?1) + (SELECT count(*) FROM attempt WHERE "
              "started_at > ?1)",
              now)};
}

}  // namespace peclet::runner
