#include "runner/reports/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "contract/errors.h"
#include "runner/campaign/quoting.h"
#include "runner/campaign/text_table.h"
#include "runner/owner/request_handler.h"
#include "runner/reports/status.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/quantity_estimates.h"
#include "runner/store/database_summary.h"
#include "runner/store/number_store.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

// Returns the point of that name, or all points if it is empty.
std::vector<PointRecord> named_points(Database& database, const std::string& name) {
  std::vector<PointRecord> points = database.points();
  if (name.empty()) return points;
  return {points[find_point(points, name)]};
}

// Returns the number of seeds of the last stop test.
int seeds_of_last_stop_test(Database& database, const PointRecord& point) {
  const std::vector<StopTestRecord> stop_tests = database.stop_tests(point.id);
  return stop_tests.empty() ? 0 : stop_tests.back().stop_test.seeds;
}

std::string line_of(const PointRecord& point, int seed, int tested, const Json& result) {
  return canonical_json({{"label", point.label},
                         {"hash", point.hash},
                         {"settings", point.settings},
                         {"seed", seed},
                         {"deciding", seed < tested},
                         {"result", result}});
}

}  // namespace

void for_each_result_line(Database& database, const std::string& name, std::optional<int> seed,
                          const std::function<void(const std::string& line)>& take) {
  bool any = false;
  for (const PointRecord& point : named_points(database, name)) {
    const int tested = seeds_of_last_stop_test(database, point);
    if (seed) {
      const std::optional<Json> result = database.result(point.id, *seed);
      if (!result) continue;
      any = true;
      take(line_of(point, *seed, tested, *result));
      continue;
    }
    database.for_each_result(point.id, std::numeric_limits<int>::max(), [&](int number, const Json& result) {
      take(line_of(point, number, tested, result));
    });
  }
  if (seed && !any) {
    throw InputError("", "--seed", std::to_string(*seed),
                     fmt::format("must be a seed that has a result{}", name.empty() ? "" : " at " + name));
  }
}

namespace {

// Returns the description of a file; its path is null if it was thrown away.
Json file_json(const FileRecord& record, const CampaignDirectory& directory) {
  return {{"name", record.file.name},
          {"bytes", record.file.bytes},
          {"sha256", record.file.sha256},
          {"path", record.kept ? Json(record.place(directory).string()) : Json(nullptr)}};
}

}  // namespace

std::string list_files(Database& database, const CampaignDirectory& directory, const FileChoice& options) {
  TextTable table;
  table.add_column("point", TextTable::Align::left);
  table.add_column("seed");
  table.add_column("name", TextTable::Align::left);
  table.add_column("bytes");
  table.add_column("path", TextTable::Align::left);
  Json all = Json::array();
  std::string paths;
  for (const PointRecord& point : named_points(database, options.point)) {
    for (const FileRecord& record : files_of_point(database.connection(), point.id)) {
      const std::string path = record.place(directory).string();
      if (record.kept) paths += path + '\n';
      all.push_back(file_json(record, directory));
      all.back().update({{"point", point.label}, {"hash", point.hash}, {"seed", record.seed}});
      table.add_row({point.label, fmt::format("{}", record.seed), record.file.name,
                     fmt::format("{}", record.file.bytes), record.kept ? path : "thrown away"});
    }
  }
  if (options.json) return all.dump(2) + '\n';
  if (options.paths) return paths;
  return all.empty() ? "no realisation has left a file\n" : table.text();
}

namespace {

// Returns the parts of a result that depend on scene, seed and engine alone, without its blocks.
Json content(const Json& result) {
  Json kept = Json::object();
  for (const char* const key :
       {"seed", "ending", "mean", "method", "timestep", "steps", "strain", "time", "statistical_inefficiency",
        "largest_overlap", "warnings", "gate", "final_state_sha256"}) {
    if (result.contains(key)) kept[key] = result[key];
  }
  kept["ending"].erase("state");  // a path on this machine
  return kept;
}

// Returns the content for a seed that was given up, which has no result.
Json content_without_result(const RealisationRecord& record) {
  return {{"seed", record.seed}, {"ending", {{"cause", record.cause}}}, {"mean", nullptr}};
}

Json attempt_json(const AttemptRecord& attempt) {
  const auto optional = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  return {{"worker", attempt.worker},
          {"process", attempt.process},
          {"host", attempt.host},
          {"started_at", attempt.started_at},
          {"ended_at", attempt.ended_at.empty() ? Json(nullptr) : Json(attempt.ended_at)},
          {"outcome", attempt.outcome},
          {"blamed", attempt.blamed},
          {"pardoned", attempt.pardoned},
          {"step", attempt.step},
          {"exit_status", optional(attempt.exit_status)},
          {"signal", optional(attempt.signal)},
          {"message", attempt.message}};
}

// One point of the exported document, with its seeds.
class PointExport {
 public:
  PointExport(Database& database, StopTestCheck& check, const PointRecord& point, const TargetRecord& target,
              bool canonical)
      : database_(database),
        point_(point),
        canonical_(canonical),
        stop_test_(check.last(point)),
        level_(target.level()) {
    if (!canonical_) {
      for (const AttemptRecord& attempt : database.attempts(point.id)) {
        attempts_[attempt.seed].push_back(attempt_json(attempt));
      }
      const CampaignDirectory below("");  // makes paths relative to the campaign's folder
      for (const FileRecord& record : files_of_point(database.connection(), point.id)) {
        files_[record.seed].push_back(file_json(record, below));
      }
    }
    read_results();
    read_seeds();
  }

  // Hands over the seeds, which are too large for a copy.
  Json take() {
    Json json = {
        {"label", point_.label},
        {"hash", point_.hash},
        {"scene", point_.scene},
        {"settings", point_.settings},
        {"engine", point_.engine_identity.empty() ? Json(nullptr) : Json(point_.engine_identity)},
        {"stop_test", stop_test_ ? stop_test_json(*stop_test_) : Json(nullptr)},
        {"verdict", stop_test_ && stop_test_->verdict != Verdict::more ? Json(to_string(stop_test_->verdict))
                                                                       : Json(nullptr)},
        {"derived", derived_},
        {"warnings", warnings_},
        {"quantities", estimates_.json(level_)}};
    json["realisations"] = std::move(realisations_);
    if (!canonical_) {
      json["suspect"] = point_.suspect;
      json["cancelled"] = point_.cancelled;
      json["set_aside"] = to_json(database_.set_aside(point_.hash));
      json["extra"] = std::move(extra_);
    }
    return json;
  }

 private:
  int seeds() const { return stop_test_ ? stop_test_->seeds : 0; }

  void read_results() {
    const int end = canonical_ ? seeds() : std::numeric_limits<int>::max();
    database_.for_each_result(point_.id, end, [this](int seed, const Json& result) {
      if (seed < seeds()) estimates_.add(result);
      if (derived_.is_null()) {
        derived_ = result.value("derived", Json());
        warnings_ = result.value("warnings", Json());
      }
      Json kept = content(result);
      if (!canonical_) {
        kept["cost"] = result["cost"];
        kept["ending"]["state"] = result["ending"].value("state", Json());
      }
      results_[seed] = std::move(kept);
    });
  }

  void read_seeds() {
    for (const RealisationRecord& record : database_.realisations(point_.id)) {
      const bool has_ended = record.state != SeedState::queued && record.state != SeedState::running;
      if (!has_ended || (canonical_ && record.seed >= seeds())) continue;
      const auto result = results_.find(record.seed);
      Json json = result != results_.end() ? std::move(result->second) : content_without_result(record);
      if (!record.content_sha256.empty()) json["content_sha256"] = record.content_sha256;
      if (!canonical_) {
        json["files"] = files_.contains(record.seed) ? files_.at(record.seed) : Json::array();
        json["attempts"] = attempts_[record.seed];
        json["engine"] = record.engine ? Json(*record.engine) : Json(nullptr);
      }
      (record.seed < seeds() ? realisations_ : extra_).push_back(std::move(json));
    }
  }

  Database& database_;
  const PointRecord& point_;
  bool canonical_;
  std::optional<StopTest> stop_test_;
  std::map<int, Json> attempts_, files_, results_;
  Json derived_, warnings_;
  Json realisations_ = Json::array(), extra_ = Json::array();
  double level_;
  QuantityEstimates estimates_;
};

Json heading(Database& database, const CampaignRecord& campaign, bool canonical) {
  const TargetRecord& target = campaign.target;
  Json json = {{"schema_version", 1},
               {"campaign", campaign.name},
               {"target", to_json(target.target)},
               {"realisations", {{"minimum", target.minimum}, {"maximum", target.maximum}}},
               {"points", nullptr}};
  if (canonical) return json;
  json["document"] = campaign.document;
  json["engines"] = Json::object();
  for (const EngineRecord& engine : database.engines()) {
    json["engines"][std::to_string(engine.id)] = engine.provenance;
  }
  return json;
}

}  // namespace

std::string export_json(Database& database, bool canonical) {
  // Point by point, because all points as JSON would need much more memory than the text.
  const CampaignRecord campaign = database.campaign();
  const Json outermost = heading(database, campaign, canonical);
  std::string text;
  for (const auto& [key, value] : outermost.items()) {
    text += (text.empty() ? "{" : ",") + Json(key).dump() + ':';
    if (key != "points") {
      text += canonical_json(value);
      continue;
    }
    const char* separator = "[\n";
    StopTestCheck check(database);
    std::vector<PointSummary> summaries;
    if (!canonical) summaries = summarise_points(database, campaign.target);
    for (const PointRecord& record : database.points()) {
      Json point = PointExport(database, check, record, campaign.target, canonical).take();
      if (!canonical) point["endings"] = to_json(summaries[static_cast<std::size_t>(*record.place)].endings);
      text += separator + canonical_json(point);
      separator = ",\n";
    }
    text += "\n]";
  }
  return text + "}\n";
}

// `peclet export --csv`: one row per point.

namespace {

using Fields = std::vector<std::string>;

void append(Fields& fields, const Fields& more) { fields.insert(fields.end(), more.begin(), more.end()); }

Fields mean_fields(const Estimate& estimate) {
  return {csv_number(estimate.mean), csv_number(estimate.standard_error)};
}

// Returns count, mean and standard error.
Fields estimate_fields(const Estimate& estimate) {
  Fields fields{fmt::format("{}", estimate.count)};
  append(fields, mean_fields(estimate));
  return fields;
}

std::string value_field(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? csv_text(value.get<std::string>()) : canonical_json(value);
}

// The columns that name the point of a row: label, hash, and one for each pointer that the sweep sets.
class SettingColumns {
 public:
  explicit SettingColumns(const std::vector<PointRecord>& points) {
    for (const PointRecord& point : points) {
      for (const auto& [pointer, value] : point.settings.items()) pointers_.insert(pointer);
    }
  }

  Fields titles() const {
    Fields titles{"label", "hash"};
    titles.insert(titles.end(), pointers_.begin(), pointers_.end());
    return titles;
  }
  Fields fields(const PointRecord& point) const {
    Fields fields{csv_text(point.label), point.hash};
    for (const std::string& pointer : pointers_) {
      fields.push_back(value_field(point.settings.value(pointer, Json())));
    }
    return fields;
  }

 private:
  std::set<std::string> pointers_;
};

// Returns the estimates of every quantity over the seeds of the stop test; empty before the first one.
std::vector<QuantityEstimate> point_estimates(Database& database, const PointRecord& point,
                                              const std::optional<StopTest>& stop_test) {
  QuantityEstimates estimates;
  if (stop_test) {
    database.for_each_result(point.id, stop_test->seeds,
                             [&](int, const Json& result) { estimates.add(result); });
  }
  return estimates.estimates();
}

// Returns the estimates of scalars alone, without reading results.
std::vector<QuantityEstimate> scalar_estimates(NumberStore& numbers, const PointRecord& point,
                                               const std::optional<StopTest>& stop_test) {
  QuantityEstimates estimates(QuantityEstimates::Wanted::scalars);
  if (stop_test) {
    numbers.for_each(point.id, stop_test->seeds, [&](const NumberStore::Entry& seed) {
      estimates.add(seed.layout, seed.numbers, seed.has_jammed);
    });
  }
  return estimates.estimates();
}

// Returns the band of the leading observable's curve.
Fields curve_fields(const std::optional<StopTest>& stop_test) {
  if (!stop_test || !stop_test->each.front().curve->is_known()) return Fields(4);
  const CurveBand& curve = *stop_test->each.front().curve;
  return {csv_number(curve.mean), csv_number(curve.low), csv_number(curve.high), curve.refused ? "1" : "0"};
}

Fields stop_test_fields(const std::optional<StopTest>& stop_test) {
  if (!stop_test) return Fields(10);
  Fields fields{stop_test->verdict == Verdict::more ? "" : to_string(stop_test->verdict),
                fmt::format("{}", stop_test->seeds), fmt::format("{}", stop_test->lost),
                fmt::format("{}", stop_test->estimate.count)};
  append(fields, mean_fields(stop_test->controlled));
  fields.push_back(csv_number(stop_test->controlled_half_width));
  append(fields, mean_fields(stop_test->estimate));
  fields.push_back(csv_number(stop_test->half_width));
  return fields;
}

Fields full_fields(const PointSummary& point) {
  Fields fields = estimate_fields(point.all_seeds);
  append(fields, {fmt::format("{}", point.extra()), csv_number(point.counts.cpu_seconds),
                  point.point.suspect ? "1" : "0", point.endings.has_jammed() ? "1" : "0"});
  return fields;
}

// Three columns for each scalar quantity of any point. A quantity with different units at different points
// has columns for each unit.
class ScalarColumns {
 public:
  void add(std::size_t row, const std::vector<QuantityEstimate>& estimates) {
    for (const QuantityEstimate& found : estimates) {
      // A quantity without description has no unit. It shares its column with pure numbers.
      const std::string unit = found.quantity.unit.empty() ? "1" : found.quantity.unit;
      columns_[{found.quantity.name, unit}][row] = found.estimates.front();
    }
  }
  // `others` are the titles of the columns before these.
  Fields titles(const Fields& others) const {
    Fields titles;
    for (const auto& [quantity, rows] : columns_) {
      const std::string title = title_of(quantity.first, quantity.second, others);
      append(titles, {title, title + " standard_error", title + " count"});
    }
    return titles;
  }
  Fields fields(std::size_t row) const {
    Fields fields;
    for (const auto& [quantity, rows] : columns_) {
      const auto found = rows.find(row);
      const bool is_known = found != rows.end();
      append(fields, is_known ? mean_fields(found->second) : Fields(2));
      fields.push_back(is_known ? fmt::format("{}", found->second.count) : "");
    }
    return fields;
  }

 private:
  static std::string title_of(const std::string& name, const std::string& unit, const Fields& others) {
    const bool is_taken = std::find(others.begin(), others.end(), name) != others.end();
    const std::string unambiguous = is_taken ? "quantity " + name : name;
    return csv_text(unit == "1" ? unambiguous : fmt::format("{} [{}]", unambiguous, unit));
  }

  // Estimates of each row by name and unit of the quantity.
  std::map<std::pair<std::string, std::string>, std::map<std::size_t, Estimate>> columns_;
};

}  // namespace

std::string export_csv(Database& database, bool canonical) {
  const TargetRecord target = database.campaign().target;
  const std::vector<PointRecord> points = database.points();
  std::vector<PointSummary> summaries;
  if (!canonical) summaries = summarise_points(database, target);
  const SettingColumns settings(points);
  Fields titles = settings.titles();
  append(titles, {"verdict", "seeds", "lost", "count", "mean", "standard_error", "half_width", "plain_mean",
                  "plain_standard_error", "plain_half_width"});
  const bool has_curve = target.target.tolerance.is_of_curve();
  if (has_curve) append(titles, {"curve_mean", "curve_low", "curve_high", "curve_refused"});
  if (!canonical) {
    append(titles, {"all_seeds_count", "all_seeds_mean", "all_seeds_standard_error", "extra", "cpu_seconds",
                    "suspect", "jammed"});
  }
  std::vector<Fields> rows;
  ScalarColumns scalars;
  NumberStore numbers(database.connection());
  StopTestCheck check(database);
  for (const PointRecord& point : points) {
    Fields fields = settings.fields(point);
    const std::optional<StopTest> stop_test = check.last(point);
    append(fields, stop_test_fields(stop_test));
    if (has_curve) append(fields, curve_fields(stop_test));
    if (!canonical) append(fields, full_fields(summaries[rows.size()]));
    scalars.add(rows.size(), scalar_estimates(numbers, point, stop_test));
    rows.push_back(std::move(fields));
  }
  append(titles, scalars.titles(titles));
  std::string text = csv_line(titles);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    append(rows[row], scalars.fields(row));
    text += csv_line(rows[row]);
  }
  return text;
}

// `peclet export --long`: one row per point, quantity and element.

namespace {

struct Point {
  Fields which;  // label, hash, settings
  std::vector<QuantityEstimate> estimates;
};

// Returns name, unit and value of each axis at an element, the last axis running fastest; "" beyond the last.
Fields place_fields(const Quantity& quantity, std::size_t element, std::size_t most_axes) {
  Fields fields(3 * most_axes);
  for (std::size_t axis = quantity.axes.size(); axis-- > 0;) {
    const QuantityAxis& along = quantity.axes[axis];
    fields[3 * axis] = csv_text(along.name);
    fields[3 * axis + 1] = csv_text(along.unit);
    fields[3 * axis + 2] = value_field(along.values[element % along.values.size()]);
    element /= along.values.size();
  }
  return fields;
}

Fields number_fields(const QuantityEstimate& found, std::size_t element, double confidence) {
  const Estimate& estimate = found.estimates[element];
  Fields fields = estimate_fields(estimate);
  fields.push_back(csv_number(half_width(estimate, confidence)));
  const bool is_controlled = !found.plain.empty();
  append(fields, is_controlled ? mean_fields(found.plain[element]) : Fields(2));
  return fields;
}

}  // namespace

std::string export_long_csv(Database& database) {
  const TargetRecord target = database.campaign().target;
  const std::vector<PointRecord> records = database.points();
  const SettingColumns settings(records);
  std::vector<Point> points;
  std::size_t most_axes = 1;
  StopTestCheck check(database);
  for (const PointRecord& record : records) {
    points.push_back({settings.fields(record), point_estimates(database, record, check.last(record))});
    for (const QuantityEstimate& found : points.back().estimates) {
      most_axes = std::max(most_axes, found.quantity.axes.size());
    }
  }
  Fields titles = settings.titles();
  append(titles, {"quantity", "symbol", "unit", "estimator"});
  for (std::size_t axis = 1; axis <= most_axes; ++axis) {
    const std::string name = fmt::format("axis_{}", axis);
    append(titles, {name, name + "_unit", name + "_value"});
  }
  append(titles, {"count", "mean", "standard_error", "half_width", "plain_mean", "plain_standard_error"});
  std::string text = csv_line(titles);
  for (const Point& point : points) {
    for (const QuantityEstimate& found : point.estimates) {
      const Quantity& quantity = found.quantity;
      for (std::size_t k = 0; k < found.estimates.size(); ++k) {
        Fields fields = point.which;
        append(fields, {csv_text(quantity.name), csv_text(quantity.symbol), csv_text(quantity.unit),
                        estimator_of(quantity)});
        append(fields, place_fields(quantity, k, most_axes));
        append(fields, number_fields(found, k, target.level()));
        text += csv_line(fields);
      }
    }
  }
  return text;
}

}  // namespace peclet::runner
