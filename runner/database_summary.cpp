#include "runner/database_summary.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace peclet::runner {
namespace {

struct Aggregate {
  StateCounts counts;
  Estimate so_far{0, std::nan(""), std::nan("")};
};

// Two passes over the values, so that their spread does not drown in a large mean.
std::map<std::int64_t, Aggregate> read_aggregates(Connection& connection) {
  Statement query(connection,
                  "WITH controlled AS (SELECT *, value + coalesce(control, 0) AS estimated FROM realisation) "
                  "SELECT r.point_id, sum(state = 'queued'), sum(state = 'running'), sum(state = 'done'),"
                  " sum(state = 'failed'), sum(state = 'quarantined'), total(cpu_seconds), count(estimated),"
                  " mean, sum((estimated - mean) * (estimated - mean))"
                  " FROM controlled r JOIN (SELECT point_id, avg(estimated) AS mean FROM controlled GROUP BY"
                  " point_id) USING (point_id) GROUP BY r.point_id");
  std::map<std::int64_t, Aggregate> aggregates;
  while (query.step()) {
    Aggregate& aggregate = aggregates[query.integer(0)];
    const auto count = [&](int column) { return static_cast<int>(query.integer(column)); };
    aggregate.counts = {count(1), count(2), count(3), count(4), count(5), query.real(6)};
    aggregate.so_far.count = count(7);
    aggregate.so_far.mean = query.real(8);
    const double values = query.real(7);
    if (values >= 2) aggregate.so_far.standard_error = std::sqrt(query.real(9) / (values - 1) / values);
  }
  return aggregates;
}

using CountsByPoint = std::map<std::int64_t, std::map<std::string, int>>;

// Of rows of point, name and count.
CountsByPoint counts_by_point(Connection& connection, const char* sql) {
  Statement query(connection, sql);
  CountsByPoint counts;
  while (query.step()) counts[query.integer(0)][query.text(1)] = static_cast<int>(query.integer(2));
  return counts;
}

CountsByPoint read_losses(Connection& connection) {
  return counts_by_point(connection,
                         "SELECT point_id, cause, count(*) FROM realisation WHERE state IN ('failed',"
                         " 'quarantined') GROUP BY point_id, cause");
}

CountsByPoint read_flags(Connection& connection) {
  return counts_by_point(connection,
                         "SELECT point_id, message, count(DISTINCT seed) FROM event WHERE kind = 'flag'"
                         " GROUP BY point_id, message");
}

// Of the seeds that are wanted.
void count_ended(Connection& connection, PointSummary& summary) {
  Statement query(connection,
                  "SELECT count(*), total(cpu_seconds) FROM realisation WHERE point_id = ? AND seed < ? AND "
                  "state IN ('done',"
                  " 'failed', 'quarantined')");
  query.bind(summary.point.id).bind(summary.wanted).step();
  summary.wanted_ended = static_cast<int>(query.integer(0));
  summary.wanted_cpu_seconds = query.real(1);
}

}  // namespace

std::vector<PointSummary> summarise_points(Database& database, const TargetRecord& target) {
  Connection& connection = database.connection();
  std::map<std::int64_t, Aggregate> aggregates = read_aggregates(connection);
  CountsByPoint losses = read_losses(connection);
  CountsByPoint flags = read_flags(connection);
  const bool any_apart = connection.integer("SELECT count(*) FROM point WHERE kept_apart = 1") > 0;
  const std::map<std::int64_t, StoredPrediction> predictions = stored_predictions(connection);
  const std::vector<int> schedule = look_schedule(target.minimum, target.maximum);

  std::vector<PointSummary> summaries;
  for (PointRecord& point : database.points()) {
    PointSummary summary;
    const Aggregate& aggregate = aggregates[point.id];
    summary.confidence = target.target.confidence;
    summary.counts = aggregate.counts;
    summary.so_far = aggregate.so_far;
    summary.losses = std::move(losses[point.id]);
    summary.flags = std::move(flags[point.id]);
    for (LookRecord& record : database.looks(point.id)) summary.looks.push_back(record.look);
    summary.decided = !summary.looks.empty() && summary.looks.back().verdict != Verdict::more;
    const int seen = summary.looks.empty() ? 0 : summary.looks.back().seeds;
    summary.wanted = summary.decided ? seen : *std::upper_bound(schedule.begin(), schedule.end() - 1, seen);
    if (const auto known = predictions.find(point.id); known != predictions.end()) {
      summary.prediction = known->second;
    }
    if (summary.counts.running > 0) summary.leases = database.leases(point.id);
    if (any_apart) summary.kept_apart = database.kept_apart(point.hash);
    summary.point = std::move(point);
    count_ended(connection, summary);
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace peclet::runner
