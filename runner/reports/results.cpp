#include "runner/reports/results.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "contract/input_error.h"
#include "runner/requests/point_name.h"

namespace peclet::runner {
namespace {

// Seeds that the last look counts.
int seeds_of_last_look(Database& database, const PointRecord& point) {
  const std::vector<LookRecord> looks = database.looks(point.id);
  return looks.empty() ? 0 : looks.back().look.seeds;
}

std::string line_of(const PointRecord& point, int seed, int looked_at, const Json& result) {
  return canonical_json({{"label", point.label},
                         {"hash", point.hash},
                         {"settings", point.settings},
                         {"seed", seed},
                         {"deciding", seed < looked_at},
                         {"result", result}});
}

}  // namespace

void for_each_result_line(Database& database, const std::string& name, std::optional<int> seed,
                          const std::function<void(const std::string& line)>& take) {
  std::vector<PointRecord> points = database.points();
  if (!name.empty()) points = {points[find_point(points, name)]};
  bool any = false;
  for (const PointRecord& point : points) {
    const int looked_at = seeds_of_last_look(database, point);
    if (seed) {
      const std::optional<Json> result = database.result(point.id, *seed);
      if (!result) continue;
      any = true;
      take(line_of(point, *seed, looked_at, *result));
      continue;
    }
    database.for_each_result(point.id, std::numeric_limits<int>::max(), [&](int number, const Json& result) {
      take(line_of(point, number, looked_at, result));
    });
  }
  if (seed && !any) {
    throw InputError("", "--seed", std::to_string(*seed),
                     fmt::format("must be a seed that has a result{}", name.empty() ? "" : " at " + name));
  }
}

}  // namespace peclet::runner
