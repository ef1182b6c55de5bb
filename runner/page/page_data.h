// All that the page of a campaign shows, as one JSON document.
//
// It is made of aggregates: whatever the number of seeds, a point takes some kilobytes, and only some of its
// results are read.
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
  std::string name;     // of the quantity
  std::string element;  // "xy"; "" of a quantity that is one number
  std::string symbol, unit;
};
Json to_json(const Drawable& one);
// Returns the path of what a target calls "pressure" or "/stress/total/3".
std::string bare(const std::string& observable);

// What takes time to read of a point: all that depends on its seeds one by one. While `key` is what it was,
// so is the rest.
struct KnownPoint {
  std::string key;
  Json json = Json::object();  // members of the point
  std::vector<Drawable> drawables;
  std::vector<Json> estimates;  // in step with these: [mean, standard error, half-width, count]
  Json warnings;                // of the engine in its first result
};
using KnownPoints = std::map<std::int64_t, KnownPoint>;  // by PointRecord::id

// The points with their estimates of every drawable, in step with `drawables`. What is not known yet, or has
// changed, is read.
struct PagePoints {
  std::vector<Drawable> drawables;
  Json points = Json::array();
};
PagePoints page_points(Database& database, const CampaignStatus& status, KnownPoints& known);

// What is in the results of a point and in no column of the database: the course of the target within the
// window, and profiles and distributions.
//
// Results are read whole, some milliseconds each, so that of a point with very many seeds the first ones
// stand for all.
constexpr int most_detailed_seeds = 64;

// {"seeds": how many results it is made of, "of": how many the estimate of the point is made of, "blocks",
// null without: {"mean", "half_width"}, "profiles": [{"name", "symbol", "unit", "axis": {"name", "unit",
// "values"}, "mean", "standard_error", "half_width"}]}: means over the first `seeds` results below the seed
// `end`, half-widths at the level of the target. Profiles are quantities over one axis of numbers; a longer
// one than 400 numbers is thinned.
Json point_details(Database& database, std::int64_t point, int end, const TargetRecord& target, int seeds);

// What the sweep sets, each key as of Vocabulary::key().
Json page_parameters(const CampaignStatus& status, const Vocabulary& words);

// Reads one campaign again and again, and of its points only those anew that have changed.
class PageReader {
 public:
  // `whole`: with the details of every point and the hash of the results, which take seconds in a large
  // campaign. `owner`: the process that runs it now. Throws IntegrityError when stored stop tests are not
  // what the stored results say.
  Json read(Database& database, std::optional<std::int64_t> owner, bool whole);

  // Of a point that was there when it was last read, by its hash: a word that changes when its results do,
  // and point_details() of it.
  std::optional<std::string> key(const std::string& hash) const;
  Json details(Database& database, const std::string& hash) const;

 private:
  const PointSummary* find(const std::string& hash) const;

  CampaignStatus status_;
  KnownPoints known_;
};

// The whole of it. Without an owner it depends on the database alone.
Json page_data(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
