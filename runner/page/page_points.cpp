// The points of the page. Their numbers are in columns that all points share.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "contract/decimal.h"
#include "runner/page/page_data.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/quantities.h"
#include "runner/statistics/quantity_estimates.h"
#include "runner/statistics/stop_rule.h"
#include "runner/store/database_summary.h"
#include "runner/store/number_store.h"

namespace peclet::runner {

Json to_json(const Drawable& one) {
  return {{"path", one.path},
          {"name", one.name},
          {"element", one.element},
          {"symbol", one.symbol},
          {"unit", one.unit}};
}

std::string bare(const std::string& observable) {
  return observable.starts_with('/') ? observable.substr(1) : observable;
}

namespace {

bool is_profile(const Quantity& quantity) {
  if (quantity.axes.size() != 1 || quantity.elements() < 2) return false;
  const Json& values = quantity.axes.front().values;
  return std::all_of(values.begin(), values.end(), [](const Json& value) { return value.is_number(); });
}

Json profile_json(const QuantityEstimate& found, double level) {
  constexpr std::size_t most_values = 400;
  const Quantity& quantity = found.quantity;
  const QuantityAxis& axis = quantity.axes.front();
  const std::size_t stride = 1 + (quantity.elements() - 1) / most_values;
  Json values = Json::array(), means = Json::array(), errors = Json::array(), widths = Json::array();
  for (std::size_t k = 0; k < quantity.elements(); k += stride) {
    const Estimate& estimate = found.estimates[k];
    values.push_back(axis.values[k]);
    means.push_back(number_json(estimate.mean));
    errors.push_back(number_json(estimate.standard_error));
    widths.push_back(number_json(half_width(estimate, level)));
  }
  return {{"name", quantity.name}, {"symbol", quantity.symbol},
          {"unit", quantity.unit}, {"axis", {{"name", axis.name}, {"unit", axis.unit}, {"values", values}}},
          {"mean", means},         {"standard_error", errors},
          {"half_width", widths}};
}

// The mean over the seeds for each block of the measured window.
class Blocks {
 public:
  void add(const std::vector<double>& values) {
    if (values.empty() || (!sums_.empty() && sums_.size() != values.size())) return;
    sums_.resize(values.size());
    for (std::size_t block = 0; block < values.size(); ++block) {
      if (!std::isnan(values[block])) sums_[block].add(values[block]);
    }
  }
  Json json(double level) const {
    if (sums_.empty()) return nullptr;
    Json means = Json::array(), widths = Json::array();
    for (const RunningEstimate& sum : sums_) {
      means.push_back(number_json(sum.estimate().mean));
      widths.push_back(number_json(half_width(sum.estimate(), level)));
    }
    return {{"mean", means}, {"half_width", widths}};
  }

 private:
  std::vector<RunningEstimate> sums_;
};

}  // namespace

Json point_details(Database& database, std::int64_t point, int end, const TargetRecord& target, int seeds) {
  const std::vector<int> completed = database.completed(point, end);
  // The seed after the first `seeds` that have completed.
  const int beyond =
      static_cast<int>(completed.size()) < seeds ? end : completed[static_cast<std::size_t>(seeds) - 1] + 1;
  QuantityEstimates sums;
  Blocks blocks;
  int read = 0;
  database.for_each_result(point, beyond, [&](int, const Json& result) {
    if (!result.at("mean").is_object()) return;
    ++read;
    sums.add(result);
    blocks.add(block_values(result, target.target.observable));
  });
  Json profiles = Json::array();
  for (const QuantityEstimate& found : sums.estimates()) {
    if (is_profile(found.quantity)) profiles.push_back(profile_json(found, target.level()));
  }
  return {{"seeds", read},
          {"of", completed.size()},
          {"blocks", blocks.json(target.level())},
          {"profiles", profiles}};
}

namespace {

// Returns the value with six digits, which are enough for a line; null if it is not finite.
Json drawn(double value) {
  if (!std::isfinite(value)) return nullptr;
  return with_digits(value, 6);
}

// The values of the leading observable in the order of the seeds, up to the first seed that has not ended.
struct Values {
  std::vector<double> values;
  std::vector<int> seeds;  // number of seeds up to each value
  int closed = 0;
  bool is_share = false;
};

Values values_of(const std::vector<std::optional<Outcome>>& outcomes, int end) {
  Values found;
  for (const std::optional<Outcome>& outcome : outcomes) {
    if (!outcome || found.closed == end) break;
    ++found.closed;
    if (outcome->is_lost()) continue;
    found.values.push_back(outcome->controlled());
    found.seeds.push_back(found.closed);
    found.is_share = outcome->is_share;
  }
  return found;
}

// True if the running mean over this number of seeds is drawn. Some fifty numbers at equal ratios are.
bool is_drawn(int seeds) {
  constexpr int all_until = 16;
  constexpr double ratio = 1.12;
  if (seeds <= all_until) return true;
  const auto step = [&](int n) { return std::floor(std::log(n) / std::log(ratio)); };
  return step(seeds) != step(seeds - 1);
}

Json running_mean(const Values& found, StopRule& rule) {
  Json seeds = Json::array(), means = Json::array(), widths = Json::array();
  RunningEstimate estimate;
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    estimate.add(found.values[i], found.is_share);
    if (!is_drawn(found.seeds[i]) && i + 1 < found.values.size()) continue;
    const Estimate now = estimate.estimate();
    seeds.push_back(found.seeds[i]);
    means.push_back(drawn(now.mean));
    widths.push_back(drawn(rule.half_width(now)));
  }
  return {{"seeds", seeds}, {"mean", means}, {"half_width", widths}};
}

// Returns the values themselves if they are few, otherwise a histogram over equal parts of their range.
Json scatter(const Values& found) {
  constexpr std::size_t most_values = 200;
  if (found.values.size() <= most_values) {
    Json values = Json::array();
    for (const double value : found.values) values.push_back(drawn(value));
    return {{"seeds", found.seeds}, {"values", values}};
  }
  const auto [low, high] = std::minmax_element(found.values.begin(), found.values.end());
  const auto bins = static_cast<std::size_t>(std::min(40.0, std::ceil(std::sqrt(found.values.size()))));
  const double width = (*high - *low) / static_cast<double>(bins);
  std::vector<int> counts(width > 0 ? bins : 1);
  for (const double value : found.values) {
    const double place = width > 0 ? (value - *low) / width : 0;
    ++counts[std::min(counts.size() - 1, static_cast<std::size_t>(place))];
  }
  return {{"low", *low}, {"high", *high}, {"counts", counts}};
}

// Returns the half-width that a criterion allows at a stop test: that of the rule or, if there is no
// interval, that which follows from the means.
Json good_enough(const Criterion& criterion, const StopTest& stop_test, const Target& target) {
  for (const ObservableStopTest& one : each_of(stop_test, target)) {
    if (one.observable == criterion.observable && one.share > 0)
      return number_json(one.half_width / one.share);
  }
  const std::vector<std::string> observables = target.observables();
  const std::vector<Estimate> estimates = estimates_of(stop_test, target);
  const std::string& measure =
      criterion.tolerance.relative_to.empty() ? criterion.observable : criterion.tolerance.relative_to;
  const auto place = std::find(observables.begin(), observables.end(), measure) - observables.begin();
  return number_json(criterion.tolerance.half_width(estimates.at(static_cast<std::size_t>(place)).mean));
}

Json stop_tests_json(const std::vector<StopTest>& stop_tests, const Target& target) {
  Json list = Json::array();
  for (const StopTest& stop_test : stop_tests) {
    list.push_back({{"seeds", stop_test.seeds},
                    {"mean", number_json(stop_test.controlled.mean)},
                    {"half_width", number_json(stop_test.controlled_half_width)},
                    {"good_enough", good_enough(target.criteria().front(), stop_test, target)},
                    {"verdict", to_string(stop_test.verdict)}});
  }
  return list;
}

Json numbers(const Estimate& estimate, double half_width) {
  return {number_json(estimate.mean), number_json(estimate.standard_error), number_json(half_width),
          estimate.count};
}

std::vector<Drawable> drawables_of(const Quantity& quantity) {
  std::vector<Drawable> found;
  for (std::size_t k = 0; k < quantity.elements(); ++k) {
    Drawable one{quantity.name, quantity.name, "", quantity.symbol, quantity.unit};
    std::string path, element;
    std::size_t rest = k;
    for (std::size_t axis = quantity.axes.size(); axis-- > 0;) {
      const Json& values = quantity.axes[axis].values;
      const std::size_t index = rest % values.size();
      const Json& value = values[index];
      path = fmt::format("/{}", index) + path;
      const std::string word = value.is_string() ? value.get<std::string>() : value.dump();
      element = element.empty() ? word : word + ", " + element;
      rest /= values.size();
    }
    one.path += path;
    one.element = element;
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace

Json first_result(Database& database, std::int64_t point) {
  std::vector<int> seeds = database.completed(point, most_realisations);
  if (seeds.empty()) {
    for (const RealisationRecord& seed : database.realisations(point)) seeds.push_back(seed.seed);
  }
  for (const int seed : seeds) {
    if (std::optional<Json> result = database.result(point, seed)) return std::move(*result);
  }
  return Json::object();
}

namespace {

// Returns the bands of curves that are known and not refused: {"relative_viscosity": {"mean", "low",
// "high"}}.
Json bands_json(const StopTest& stop_test) {
  Json bands = Json::object();
  for (const ObservableStopTest& one : stop_test.each) {
    if (!one.curve || !one.curve->is_known() || one.curve->refused) continue;
    bands[bare(one.observable)] = {
        {"mean", one.curve->mean}, {"low", one.curve->low}, {"high", one.curve->high}};
  }
  return bands;
}

// Returns what of a stop test may change without new seeds of its point.
std::string last_text(const StopTest& stop_test) {
  return fmt::format("{} {} {}", stop_test.seeds, to_string(stop_test.verdict), bands_json(stop_test).dump());
}

// Returns a key that changes with the seeds that have ended, their values and the stop tests.
std::string key_of(const PointSummary& point, const TargetRecord& target) {
  const StateCounts& counts = point.counts;
  return fmt::format("{} {} {} {} {:a} {} {:a} {:a} {} {}", target.id, counts.done, counts.failed,
                     counts.quarantined, counts.cpu_seconds, point.all_seeds.count, point.all_seeds.mean,
                     point.all_seeds.standard_error, point.stop_tests.size(),
                     point.stop_tests.empty() ? "" : last_text(point.stop_tests.back()));
}

class PointPage {
 public:
  PointPage(Database& database, StopTestCheck& check, NumberStore& book, const TargetRecord& target,
            const PointSummary& point)
      : database_(database),
        book_(book),
        target_(target),
        point_(point),
        stop_test_(check.last(point.point)) {}

  KnownPoint read() {
    const Target& target = target_.target;
    StopRule rule(target, target_.minimum, target_.maximum);
    const Values found = values_of(database_.outcomes(point_.point.id), end());
    const Json first = first_result(database_, point_.point.id);
    known_.key = key_of(point_, target_);
    known_.warnings = first.value("warnings", Json::array());
    known_.json = {{"groups", first.value("derived", Json())},
                   {"stop_tests", stop_tests_json(point_.stop_tests, target)},
                   {"running_mean", running_mean(found, rule)},
                   {"scatter", scatter(found)},
                   {"plain", Json::object()},
                   {"curve", stop_test_ ? bands_json(*stop_test_) : Json::object()},
                   {"good_enough", Json::object()}};
    add_estimates();
    if (stop_test_) add_deciding();
    return std::move(known_);
  }

 private:
  // Returns the number of seeds of the stop test; before the first one, no limit.
  int end() const { return stop_test_ ? stop_test_->seeds : std::numeric_limits<int>::max(); }

  void add_estimates() {
    QuantityEstimates sums;
    book_.for_each(point_.point.id, end(), [&](const NumberStore::Entry& seed) {
      sums.add(seed.layout, seed.numbers, seed.has_jammed);
    });
    const auto of = [&](const Estimate& one) { return numbers(one, half_width(one, target_.level())); };
    for (const QuantityEstimate& found : sums.estimates()) {
      const std::vector<Drawable> drawables = drawables_of(found.quantity);
      for (std::size_t k = 0; k < drawables.size(); ++k) {
        known_.estimates.push_back(of(found.estimates[k]));
        known_.drawables.push_back(drawables[k]);
        if (!found.plain.empty()) {
          known_.json["plain"][drawables[k].path] = of(found.plain[k]);
        }
      }
    }
  }

  // Replaces the estimates of the target's observables by those of the stop test, whose intervals decide.
  void add_deciding() {
    const Target& target = target_.target;
    for (const ObservableStopTest& one : each_of(*stop_test_, target)) {
      const std::size_t place = place_of(one.observable);
      known_.estimates[place] = numbers(one.estimate, one.half_width);
      if (one.observable == target.observable && has_control(*stop_test_)) {
        known_.json["plain"][known_.drawables[place].path] =
            numbers(stop_test_->estimate, stop_test_->half_width);
      }
    }
    for (const Criterion& criterion : target.criteria()) {
      known_.json["good_enough"][bare(criterion.observable)] = good_enough(criterion, *stop_test_, target);
    }
  }

  // Returns the place of an observable. Adds it, without a unit, if the results do not describe it.
  std::size_t place_of(const std::string& observable) {
    const std::string path = bare(observable);
    for (std::size_t place = 0; place < known_.drawables.size(); ++place) {
      if (known_.drawables[place].path == path) return place;
    }
    known_.drawables.push_back({path, path, "", "", ""});
    known_.estimates.emplace_back(nullptr);
    return known_.drawables.size() - 1;
  }

  Database& database_;
  NumberStore& book_;
  const TargetRecord& target_;
  const PointSummary& point_;
  std::optional<StopTest> stop_test_;
  KnownPoint known_;
};

// The columns, one for each path and unit, in the order in which they are first met.
class Columns {
 public:
  std::size_t of(const Drawable& one) {
    const auto [known, is_new] = places_.emplace(std::make_pair(one.path, one.unit), drawables.size());
    if (is_new) drawables.push_back(one);
    return known->second;
  }
  std::vector<Drawable> drawables;

 private:
  std::map<std::pair<std::string, std::string>, std::size_t> places_;
};

Json estimates_json(const KnownPoint& known, Columns& columns) {
  Json estimates = Json::array();
  for (std::size_t place = 0; place < known.drawables.size(); ++place) {
    const std::size_t column = columns.of(known.drawables[place]);
    while (estimates.size() <= column) estimates.push_back(nullptr);
    estimates[column] = known.estimates[place];
  }
  return estimates;
}

Json point_json(const PointSummary& point) {
  const StateCounts& counts = point.counts;
  return {{"label", point.point.label},
          {"hash", point.point.hash},
          {"settings", point.point.settings},
          {"state", state_word(point)},
          {"verdict", verdict_text(point)},
          {"marks", reservations(point)},
          {"decided", point.decided},
          {"seeds",
           {{"tested", point.stop_tests.empty() ? Json(nullptr) : Json(point.stop_tests.back().seeds)},
            {"wanted", point.wanted},
            {"wanted_ended", point.wanted_ended},
            {"ended", counts.terminal()},
            {"running", counts.running},
            {"extra", point.extra()}}},
          {"endings", to_json(point.endings)},
          {"losses", point.losses},
          {"loss_reasons", point.loss_reasons},
          {"flags", point.flags},
          {"cpu_seconds", counts.cpu_seconds}};
}

}  // namespace

PagePoints page_points(Database& database, const CampaignStatus& status, KnownPoints& known) {
  NumberStore book(database.connection());
  StopTestCheck check(database);
  Columns columns;
  PagePoints page;
  for (const PointSummary& point : status.points) {
    KnownPoint& of_point = known[point.point.id];
    if (of_point.key != key_of(point, status.campaign.target)) {
      of_point = PointPage(database, check, book, status.campaign.target, point).read();
    }
    Json json = point_json(point);
    json.update(of_point.json);
    json["estimates"] = estimates_json(of_point, columns);
    page.points.push_back(std::move(json));
  }
  // Earlier points lack the columns that only later ones have.
  for (Json& point : page.points) {
    while (point["estimates"].size() < columns.drawables.size()) point["estimates"].push_back(nullptr);
  }
  page.drawables = std::move(columns.drawables);
  return page;
}

}  // namespace peclet::runner
