#include "runner/database/further_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "contract/integrity_error.h"
#include "runner/statistics/look_json.h"

namespace peclet::runner {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double number(const Json& value) { return value.is_null() ? none : value.get<double>(); }

}  // namespace

std::uint64_t leading_digits(const std::string& hash) {
  constexpr std::size_t digits = 16;
  std::uint64_t number = 0;
  std::from_chars(hash.data(), hash.data() + std::min(digits, hash.size()), number, 16);
  return number;
}

Observation observation_of(const Observed& observed) {
  return {observed.value.value_or(none), observed.control.value_or(0), observed.first_quarter.value_or(none),
          observed.first_half.value_or(none), observed.is_share};
}

std::optional<std::string> further_values_text(const std::vector<std::string>& observables,
                                               const std::vector<Observed>& observed) {
  if (observables.size() < 2) return std::nullopt;
  Json values = Json::object();
  for (std::size_t place = 1; place < observables.size(); ++place) {
    const Observation of = observation_of(observed[place]);
    values[observables[place]] = {number_json(of.value), number_json(of.control),
                                  number_json(of.first_quarter), number_json(of.first_half)};
  }
  return values.dump();
}

std::vector<Observation> further_values(const std::string& text,
                                        const std::vector<std::string>& observables) {
  std::vector<Observation> further(observables.size() - 1);
  try {
    const Json values = Json::parse(text);
    for (std::size_t place = 1; place < observables.size(); ++place) {
      const auto found = values.find(observables[place]);
      if (found == values.end()) continue;
      further[place - 1] = {number(found->at(0)), number(found->at(1)), number(found->at(2)),
                            number(found->at(3))};
    }
  } catch (const Json::exception&) {
    throw IntegrityError("the database holds values that are none: " + text.substr(0, 100));
  }
  return further;
}

}  // namespace peclet::runner
