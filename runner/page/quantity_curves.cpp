#include "runner/page/quantity_curves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "contract/errors.h"

namespace peclet::runner {
namespace {

bool has_curve(const Quantity& quantity) {
  if (quantity.axes.empty() || quantity.axes.back().values.size() < 2) return false;
  const Json& values = quantity.axes.back().values;
  return std::all_of(values.begin(), values.end(), [](const Json& value) { return value.is_number(); });
}

std::string word_of(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

// The elements of all axes but the last one, the last of them running fastest: "xy", "1.4/x".
std::vector<std::string> elements_before_last(const Quantity& quantity) {
  std::vector<std::string> elements{""};
  for (std::size_t axis = 0; axis + 1 < quantity.axes.size(); ++axis) {
    std::vector<std::string> longer;
    for (const std::string& begun : elements) {
      for (const Json& value : quantity.axes[axis].values) {
        longer.push_back(begun.empty() ? word_of(value) : begun + '/' + word_of(value));
      }
    }
    elements = std::move(longer);
  }
  return elements;
}

}  // namespace

std::optional<QuantityCurve> find_curve(const std::vector<Quantity>& quantities, const std::string& name) {
  for (const Quantity& quantity : quantities) {
    if (!has_curve(quantity)) continue;
    const std::vector<std::string> elements = elements_before_last(quantity);
    if (name == quantity.name && quantity.axes.size() > 1) {
      throw InputError("", "--quantity", name,
                       fmt::format("is a curve for each element: {}; name one, as {}/{}",
                                   fmt::join(elements, ", "), name, elements.front()));
    }
    for (std::size_t k = 0; k < elements.size(); ++k) {
      if (name != quantity.name + (elements[k].empty() ? "" : '/' + elements[k])) continue;
      return QuantityCurve{{name, quantity.name, elements[k], quantity.symbol, quantity.unit},
                           quantity.axes.back(),
                           k * quantity.axes.back().values.size()};
    }
  }
  return std::nullopt;
}

std::vector<std::string> names_of_curves(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities) {
    if (!has_curve(quantity)) continue;
    const std::string first = elements_before_last(quantity).front();
    names.push_back(first.empty() ? quantity.name : quantity.name + '/' + first + " ...");
  }
  return names;
}

}  // namespace peclet::runner
