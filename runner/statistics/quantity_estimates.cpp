#include "runner/statistics/quantity_estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "contract/frames.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_like(const Quantity& one, const Quantity& other) {
  const auto same_axis = [](const QuantityAxis& a, const QuantityAxis& b) {
    return a.name == b.name && a.unit == b.unit && a.values == b.values;
  };
  return one.unit == other.unit && one.ratio == other.ratio && one.control == other.control &&
         std::equal(one.axes.begin(), one.axes.end(), other.axes.begin(), other.axes.end(), same_axis);
}

void add_number(RunningEstimate& running, double value, bool is_share = false) {
  if (!std::isnan(value)) running.add(value, is_share);
}

// Returns the numbers from `next` on as nested lists over the axes from `axis` on.
Json over_axes(const std::vector<Json>& numbers, const std::vector<QuantityAxis>& axes, std::size_t axis,
               std::size_t& next) {
  if (axis == axes.size()) return numbers[next++];
  Json list = Json::array();
  for (std::size_t k = 0; k < axes[axis].values.size(); ++k) {
    list.push_back(over_axes(numbers, axes, axis + 1, next));
  }
  return list;
}

template <typename Value>
Json column(const std::vector<Estimate>& estimates, const Quantity& quantity, const Value& value) {
  std::vector<Json> numbers;
  numbers.reserve(estimates.size());
  for (const Estimate& estimate : estimates) numbers.push_back(value(estimate));
  std::size_t next = 0;
  return over_axes(numbers, quantity.axes, 0, next);
}

Json columns(const std::vector<Estimate>& estimates, const Quantity& quantity, double confidence) {
  const auto of = [&](const auto& value) { return column(estimates, quantity, value); };
  return {{"count", of([](const Estimate& e) { return Json(e.count); })},
          {"mean", of([](const Estimate& e) { return number_json(e.mean); })},
          {"standard_error", of([](const Estimate& e) { return number_json(e.standard_error); })},
          {"half_width", of([&](const Estimate& e) { return number_json(half_width(e, confidence)); })}};
}

}  // namespace

Estimate ratio_of_means(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  const auto n = static_cast<double>(numerators.size());
  const double above = std::accumulate(numerators.begin(), numerators.end(), 0.0);
  const double below = std::accumulate(denominators.begin(), denominators.end(), 0.0);
  Estimate found{static_cast<int>(numerators.size()), below == 0 ? nan : above / below, nan};
  if (numerators.size() < 2) return found;
  std::vector<double> without(numerators.size());
  for (std::size_t i = 0; i < without.size(); ++i) {
    const double rest = below - denominators[i];
    without[i] = rest == 0 ? nan : (above - numerators[i]) / rest;
  }
  const double mean = std::accumulate(without.begin(), without.end(), 0.0) / n;
  double squares = 0;
  for (const double ratio : without) squares += (ratio - mean) * (ratio - mean);
  found.standard_error = std::sqrt((n - 1) / n * squares);
  // All seeds have the same ratio, although N and D may differ.
  if (estimate(without).values == Estimate::Values::equal) found.values = Estimate::Values::equal;
  return found;
}

QuantityEstimates::Sums& QuantityEstimates::sums_of(const Quantity& quantity) {
  const auto place =
      std::lower_bound(sums_.begin(), sums_.end(), quantity.name,
                       [](const Sums& sums, const std::string& name) { return sums.quantity.name < name; });
  if (place != sums_.end() && place->quantity.name == quantity.name) return *place;
  Sums sums{quantity, {}, {}, {}, {}};
  if (!quantity.ratio) sums.plain.resize(quantity.elements());
  if (quantity.control) sums.controlled.resize(quantity.elements());
  return *sums_.insert(place, std::move(sums));
}

void QuantityEstimates::add_numbers(Sums& sums, std::span<const double> numbers, bool has_jammed) {
  const Quantity& quantity = sums.quantity;
  const std::size_t elements = quantity.elements();
  const std::span<const double> values = numbers.first(elements), second = numbers.subspan(elements);
  if (quantity.ratio) {
    sums.numerators.emplace_back(values.begin(), values.end());
    sums.denominators.emplace_back(second.begin(), second.end());
    if (has_jammed && quantity.axes.empty() && values.front() != 0) ++sums.infinite;
    return;
  }
  for (std::size_t k = 0; k < elements; ++k) add_number(sums.plain[k], values[k], quantity.is_share);
  if (!quantity.control) return;
  // A value without its control variate counts as it is, as in a stop test.
  for (std::size_t k = 0; k < elements; ++k) {
    add_number(sums.controlled[k], values[k] + (std::isnan(second[k]) ? 0 : second[k]));
  }
}

void QuantityEstimates::add(Sums& sums, const Json& mean, bool has_jammed) {
  std::vector<double> numbers;
  append_numbers(sums.quantity, mean, numbers);
  add_numbers(sums, numbers, has_jammed);
}

bool QuantityEstimates::is_wanted(const Quantity& quantity) const {
  const bool is_named =
      names_.empty() || std::find(names_.begin(), names_.end(), quantity.name) != names_.end();
  return is_named && (wanted_ == Wanted::all || quantity.axes.empty());
}

void QuantityEstimates::add(const Json& result) {
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return;
  const bool has_jammed = is_jam(result.value(Json::json_pointer("/ending/cause"), ""));
  const bool is_first = sums_.empty();
  const auto descriptions = result.find("quantities");
  if (descriptions != result.end() && !descriptions->empty() && *descriptions == descriptions_) {
    for (Sums& sums : sums_) {
      if (descriptions->contains(sums.quantity.name)) add(sums, mean, has_jammed);
    }
    return;
  }
  for (const Quantity& quantity : quantities_of(result)) {
    if (!is_wanted(quantity)) continue;
    Sums& sums = sums_of(quantity);
    if (is_like(sums.quantity, quantity)) {
      add(sums, mean, has_jammed);
    } else {
      ++sums.unlike;
    }
  }
  if (is_first && descriptions != result.end()) descriptions_ = *descriptions;
}

void QuantityEstimates::add(const NumberLayout& layout, std::span<const double> numbers, bool has_jammed) {
  for (std::size_t place = 0; place < layout.quantities().size(); ++place) {
    const Quantity& quantity = layout.quantities()[place];
    if (!is_wanted(quantity)) continue;
    Sums& sums = sums_of(quantity);
    // Each layout is compared once: a comparison for every seed would dominate the run time.
    if (sums.followed != &layout && is_like(sums.quantity, quantity)) sums.followed = &layout;
    if (sums.followed == &layout) {
      add_numbers(sums, layout.of_quantity(place, numbers), has_jammed);
    } else {
      ++sums.unlike;
    }
  }
}

std::vector<QuantityEstimate> QuantityEstimates::estimates() const {
  std::vector<QuantityEstimate> all;
  for (const Sums& sums : sums_) {
    QuantityEstimate found{sums.quantity, {}, {}, sums.unlike};
    if (sums.quantity.control) {
      found.estimates = estimates_of(sums.controlled);
      found.plain = estimates_of(sums.plain);
    } else if (!sums.quantity.ratio) {
      found.estimates = estimates_of(sums.plain);
    } else {
      for (std::size_t k = 0; k < sums.quantity.elements(); ++k) {
        std::vector<double> above, below;
        for (std::size_t seed = 0; seed < sums.numerators.size(); ++seed) {
          if (std::isnan(sums.numerators[seed][k]) || std::isnan(sums.denominators[seed][k])) continue;
          above.push_back(sums.numerators[seed][k]);
          below.push_back(sums.denominators[seed][k]);
        }
        const int count = static_cast<int>(above.size());
        found.estimates.push_back(sums.infinite > 0 && 2 * sums.infinite >= count
                                      ? Estimate{count, nan, nan}
                                      : ratio_of_means(above, below));
      }
    }
    all.push_back(std::move(found));
  }
  return all;
}

Json QuantityEstimates::json(double confidence) const {
  Json all = Json::object();
  for (const QuantityEstimate& found : estimates()) {
    const Quantity& quantity = found.quantity;
    Json json = columns(found.estimates, quantity, confidence);
    json["symbol"] = quantity.symbol;
    json["unit"] = quantity.unit;
    json["estimator"] = estimator_of(quantity);
    json["axes"] = quantity.axes;
    if (quantity.control) json["plain"] = columns(found.plain, quantity, confidence);
    if (found.unlike > 0) json["unlike"] = found.unlike;
    all[quantity.name] = std::move(json);
  }
  return all;
}

}  // namespace peclet::runner
