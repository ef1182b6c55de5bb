// The document of a campaign's page, as JSON.
//
// It consists of aggregates: a point takes some kilobytes for any number of seeds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/reports/status.h"
#include "runner/store/database.h"
#include "runner/store/point_store.h"

namespace peclet::runner {

// A number of the results that can be drawn: a quantity, or one of its elements.
struct Drawable {
  std::string path;     // "pressure", "stress/total/3"
  std::string name;     // name of the quantity
  std::string element;  // "xy"; "" if the quantity is one number
  std::string symbol, unit;
};
Json to_json(const Drawable& one);
// Returns the path of an observable, which a target may write with a slash before it: "/stress/total/3".
std::string bare(const std::string& observable);

// The parts of a point that depend on every seed and take time to read. They are valid for the same `key`.
struct KnownPoint {
  std::string key;
  Json json = Json::object();  // members of the point
  std::vector<Drawable> drawables;
  std::vector<Json> estimates;  // one for each drawable: [mean, standard error, half-width, count]
  Json warnings;                // those of the first result
};
using KnownPoints = std::map<std::int64_t, KnownPoint>;  // by PointRecord::id

// Returns the first result of a point that has completed, otherwise the first one that has not; an empty
// object without results.
Json first_result(Database& database, std::int64_t point);

struct PagePoints {
  std::vector<Drawable> drawables;
  Json points = Json::array();  // each with "estimates", one for each drawable
};
// Returns the points of the page. Reads those that are not in `known` or have changed, and keeps them there.
PagePoints page_points(Database& database, const CampaignStatus& status, KnownPoints& known);

// The most seeds over which the details of a point are averaged, because reading a result takes milliseconds.
constexpr int most_detailed_seeds = 64;

// Returns the parts of a point's results that are in no column of the database: the course of the target
// within the measured window, profiles and distributions. They are means over the first `seeds` results below
// the seed `end`, with half-widths at the confidence level of the target:
// clang-format off
//   seeds, of  number of results here, and in the estimate of the point
//   blocks     {"mean", "half_width"}; null if results have no blocks
//   profiles   [{"name", "symbol", "unit", "axis": {"name", "unit", "values"}, "mean", "standard_error",
//              "half_width"}]: quantities over one axis of numbers, thinned if longer than 400
// clang-format on
Json point_details(Database& database, std::int64_t point, int end, const TargetRecord& target, int seeds);

// Returns the swept parameters, each as Vocabulary::key() gives it.
Json page_parameters(const CampaignStatus& status, const Vocabulary& words);

// Reads the page of one campaign repeatedly. Points that have not changed are not read again.
class PageReader {
 public:
  // Returns the document; `whole` adds the details of every point and the hash of the results, which take
  // seconds in a large campaign. `owner` is the process that runs the campaign now. Throws IntegrityError if
  // stored stop tests do not agree with the stored results.
  Json read(Database& database, std::optional<std::int64_t> owner, bool whole);

  // Returns a key that changes with the results of the point with this hash, if the last document has it.
  std::optional<std::string> key(const std::string& hash) const;
  // Returns point_details() of a point of the last document.
  Json details(Database& database, const std::string& hash) const;

 private:
  const PointSummary* find(const std::string& hash) const;

  CampaignStatus status_;
  KnownPoints known_;
};

// Returns the whole document. Without an owner it depends on the database alone.
Json page_data(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
