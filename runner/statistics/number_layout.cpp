#include "runner/statistics/number_layout.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "contract/errors.h"

namespace peclet::runner {
namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

void flatten(const Json& value, std::vector<double>& numbers) {
  if (value.is_array()) {
    for (const Json& element : value) flatten(element, numbers);
  } else {
    numbers.push_back(value.is_number() ? value.get<double>() : absent);
  }
}

// Appends the numbers at a path of the means. A single one is repeated for all `elements`; another wrong
// count gives NaN for all.
void append_at(const Json& mean, const std::string& path, std::size_t elements,
               std::vector<double>& numbers) {
  const std::size_t before = numbers.size();
  if (const Json* const value = at_path(mean, path)) flatten(*value, numbers);
  const std::size_t found = numbers.size() - before;
  if (found == elements) return;
  const double all = found == 1 ? numbers.back() : absent;
  numbers.resize(before);
  numbers.resize(before + elements, all);
}

std::vector<Quantity> small_ones(const std::vector<Quantity>& quantities) {
  std::vector<Quantity> small;
  for (const Quantity& quantity : quantities) {
    if (quantity.elements() <= NumberLayout::most_elements) small.push_back(quantity);
  }
  return small;
}

// Returns the index among the observables of a quantity that is a single number; nothing if it is not one.
std::optional<std::size_t> place_among(const std::vector<std::string>& observables,
                                       const Quantity& quantity) {
  if (!quantity.axes.empty() || quantity.ratio) return std::nullopt;
  const auto found = std::find_if(observables.begin(), observables.end(), [&](std::string_view path) {
    if (path.starts_with('/')) path.remove_prefix(1);
    return path == quantity.name;
  });
  if (found == observables.end()) return std::nullopt;
  return static_cast<std::size_t>(found - observables.begin());
}

Json description(const Quantity& quantity) {
  Json about{{"symbol", quantity.symbol}, {"unit", quantity.unit}, {"estimator", estimator_of(quantity)}};
  if (!quantity.axes.empty()) about["axes"] = quantity.axes;
  if (quantity.ratio) {
    about["numerator"] = quantity.ratio->numerator;
    about["denominator"] = quantity.ratio->denominator;
  }
  if (quantity.control) about["control"] = *quantity.control;
  return about;
}

}  // namespace

std::size_t numbers_needed(const Quantity& quantity) {
  return quantity.elements() * (quantity.ratio || quantity.control ? 2 : 1);
}

void append_numbers(const Quantity& quantity, const Json& mean, std::vector<double>& numbers) {
  const std::size_t elements = quantity.elements();
  if (quantity.ratio) {
    append_at(mean, quantity.name + '/' + quantity.ratio->numerator, elements, numbers);
    append_at(mean, quantity.name + '/' + quantity.ratio->denominator, elements, numbers);
    return;
  }
  append_at(mean, quantity.name, elements, numbers);
  if (!quantity.control) return;
  append_at(mean, quantity.control->quantity, elements, numbers);
  for (auto control = numbers.end() - static_cast<std::ptrdiff_t>(elements); control != numbers.end();
       ++control)
    *control -= quantity.control->mean;
}

NumberLayout::NumberLayout(std::vector<Quantity> quantities, std::vector<std::string> observables)
    : observables_(std::move(observables)),
      quantities_(std::move(quantities)),
      count_(numbers_of_observation * observables_.size()) {
  for (const Quantity& quantity : quantities_) {
    if (const std::optional<std::size_t> place = place_among(observables_, quantity)) {
      begins_.push_back(numbers_of_observation * *place);
    } else {
      begins_.push_back(count_);
      count_ += numbers_needed(quantity);
    }
  }
}

NumberLayout::NumberLayout(const Json& result, std::vector<std::string> observables)
    : NumberLayout(small_ones(quantities_of(result)), std::move(observables)) {}

NumberLayout NumberLayout::of_text(const std::string& text) {
  try {
    const Json layout = Json::parse(text);
    return NumberLayout(quantities_of({{"quantities", layout.at("quantities")}, {"mean", nullptr}}),
                        layout.at("observables").get<std::vector<std::string>>());
  } catch (const Json::exception&) {
    throw IntegrityError("the database holds a layout of numbers that cannot be read; it begins with " +
                         text.substr(0, 100));
  }
}

std::vector<double> NumberLayout::numbers(const Json& result) const {
  std::vector<double> numbers;
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return numbers;
  numbers.reserve(count_);
  for (const std::string& observable : observables_) append_observation(result, observable, numbers);
  for (const Quantity& quantity : quantities_) {
    if (!place_among(observables_, quantity)) append_numbers(quantity, mean, numbers);
  }
  return numbers;
}

Observation NumberLayout::observation(std::size_t place, std::span<const double> numbers) const {
  return observation_of(numbers.subspan(numbers_of_observation * place, numbers_of_observation),
                        is_share(quantities_, observables_[place]));
}

std::string NumberLayout::text() const {
  Json about = Json::object();
  for (const Quantity& quantity : quantities_) about[quantity.name] = description(quantity);
  return Json{{"observables", observables_}, {"quantities", about}}.dump();
}

}  // namespace peclet::runner
