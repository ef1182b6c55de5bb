#include "runner/statistics/number_layout.h"

#include <limits>
#include <utility>

#include "contract/integrity_error.h"

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

// The numbers at a path of the means; one alone, or a null, stands for all `elements`.
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

Json description(const Quantity& quantity) {
  Json about{{"symbol", quantity.symbol}, {"unit", quantity.unit}, {"estimator", estimator_of(quantity)}};
  for (const QuantityAxis& axis : quantity.axes)
    about["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", axis.values}});
  if (quantity.ratio) {
    about["numerator"] = quantity.ratio->numerator;
    about["denominator"] = quantity.ratio->denominator;
  }
  if (quantity.control)
    about["control"] = {{"quantity", quantity.control->quantity}, {"mean", quantity.control->mean}};
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
  if (quantity.control) append_at(mean, quantity.control->quantity, elements, numbers);
}

NumberLayout::NumberLayout(std::vector<Quantity> quantities) : quantities_(std::move(quantities)) {
  for (const Quantity& quantity : quantities_) count_ += numbers_needed(quantity);
}

NumberLayout::NumberLayout(const Json& result) : NumberLayout(small_ones(quantities_of(result))) {}

NumberLayout NumberLayout::of_text(const std::string& text) {
  try {
    return NumberLayout(quantities_of({{"quantities", Json::parse(text)}, {"mean", nullptr}}));
  } catch (const Json::exception&) {
    throw IntegrityError("the database holds a layout of numbers that is none: " + text.substr(0, 100));
  }
}

std::vector<double> NumberLayout::numbers(const Json& result) const {
  std::vector<double> numbers;
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return numbers;
  numbers.reserve(count_);
  for (const Quantity& quantity : quantities_) append_numbers(quantity, mean, numbers);
  return numbers;
}

std::string NumberLayout::text() const {
  Json about = Json::object();
  for (const Quantity& quantity : quantities_) about[quantity.name] = description(quantity);
  return about.dump();
}

}  // namespace peclet::runner
