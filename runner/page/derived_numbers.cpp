#include "runner/page/derived_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "contract/errors.h"
#include "contract/text.h"

namespace peclet::runner {
namespace {

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

std::string unit_of(const Json& described) { return described.at("unit").get<std::string>(); }

// Returns the symbol of a number in a product or quotient; its name if it has none.
std::string factor_text(const Json& described) {
  std::string symbol = described.at("symbol").get<std::string>();
  if (symbol.empty()) return described.at("words").get<std::string>();
  return symbol.find_first_of(" /") == std::string::npos ? symbol : '(' + symbol + ')';
}

}  // namespace

DerivedNumbers::DerivedNumbers(const Vocabulary& words, const Json& points) : descriptions_(words.derived()) {
  for (const Json& point : points) {
    labels_.push_back(point.at("label").get<std::string>());
    groups_.push_back(point.at("groups"));
  }
}

Json DerivedNumbers::described(const std::string& name) const {
  Json found = {{"pointer", name}, {"words", ""}, {"symbol", ""}, {"unit", ""}, {"meaning", ""}};
  for (const Json& one : descriptions_) {
    if (one.at("name") != name) continue;
    for (const char* const member : {"words", "symbol", "unit"}) found[member] = one.value(member, "");
  }
  if (found["words"].get<std::string>().empty()) {
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    found["words"] = words;
  }
  return found;
}

bool DerivedNumbers::is_everywhere(const std::string& name) const {
  return std::all_of(groups_.begin(), groups_.end(), [&](const Json& groups) {
    return groups.is_object() && groups.value(name, Json()).is_number();
  });
}

std::vector<std::string> DerivedNumbers::names() const {
  std::vector<std::string> names;
  for (const Json& one : descriptions_) {
    if (is_everywhere(one.at("name"))) names.push_back(one.at("name"));
  }
  return names;
}

Json DerivedNumbers::parameter(const std::string& name) const {
  const bool is_known = std::any_of(groups_.begin(), groups_.end(), [&](const Json& groups) {
    return groups.is_object() && groups.contains(name);
  });
  return is_known ? described(name) : Json();
}

std::vector<double> DerivedNumbers::values(const std::string& option, const std::string& name) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Json value = groups_[i].is_object() ? groups_[i].value(name, Json()) : Json();
    if (!value.is_number() || value == 0) {
      throw InputError(
          "", option, name,
          fmt::format("is not defined at {}: its scene lacks what this number follows from{}", labels_[i],
                      option.starts_with("--scale") ? "; a number > 0 scales all points alike" : ""));
    }
    values.push_back(value.get<double>());
  }
  return values;
}

std::string DerivedNumbers::named_by(const std::string& unit) const {
  for (const Json& one : descriptions_) {
    if (!unit.empty() && without_blanks(one.value("symbol", "")) == without_blanks(unit))
      return one.at("name");
  }
  return "";
}

int DerivedNumbers::power_of(const std::string& name, const std::string& unit) const {
  const std::string own = without_blanks(unit_of(described(name))), other = without_blanks(unit);
  if (own.empty()) return 0;
  return own == other ? 1 : "1/" + own == other || own == "1/" + other ? -1 : 0;
}

AxisScale DerivedNumbers::scale(const std::string& option, const std::string& wanted,
                                const std::string& unit) const {
  AxisScale scale{"", unit, std::vector<double>(groups_.size(), 1.0)};
  if (const std::optional<double> number = number_in<double>(wanted); number && *number > 0) {
    std::fill(scale.factors.begin(), scale.factors.end(), 1 / *number);
    scale.text = " / " + wanted;
    scale.unit = "1";
    return scale;
  }
  std::string given_in = unit;
  if (const std::string of_unit = named_by(unit); !of_unit.empty() && of_unit != wanted) {
    scale.factors = values(option, of_unit);
    given_in = unit_of(described(of_unit));
  } else if (of_unit == wanted && !of_unit.empty()) {
    throw InputError("", option, wanted, fmt::format("is the unit of these numbers already, {}", unit));
  }
  std::vector<std::string> fitting;
  for (const std::string& name : names()) {
    if (name != named_by(unit) && power_of(name, given_in) != 0) fitting.push_back(name);
  }
  const std::string allowed = fitting.empty() ? "" : fmt::format(", or {}", fmt::join(fitting, ", "));
  const bool is_known =
      std::ranges::any_of(descriptions_, [&](const Json& one) { return one["name"] == wanted; });
  if (!is_known && parameter(wanted).is_null()) {
    throw InputError("", option, wanted,
                     fmt::format("must be a number > 0{}{}", allowed, suggestion(wanted, names())));
  }
  const int power = power_of(wanted, given_in);
  if (power == 0) {
    throw InputError("", option, wanted,
                     fmt::format("has the unit {}, and these numbers {}; must be a number > 0{}",
                                 unit_of(described(wanted)), given_in.empty() ? "none" : given_in, allowed));
  }
  const std::vector<double> numbers = values(option, wanted);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    scale.factors[i] = power > 0 ? scale.factors[i] / numbers[i] : scale.factors[i] * numbers[i];
  }
  scale.text = (power > 0 ? " / " : " ") + factor_text(described(wanted));
  scale.unit = "1";
  return scale;
}

}  // namespace peclet::runner
