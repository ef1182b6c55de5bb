// What a realisation says of the observables of a target but the leading one, as the table `realisation`
// keeps it: {"pressure": [value, control, first quarter, first half]}, null for what does not exist.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/folder/realisation_result.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// The first 16 hexadecimal digits of a hash as a number; 0 for none.
std::uint64_t leading_digits(const std::string& hash);

Observation observation_of(const Observed& observed);

// `observed` is of `observables`, the leading one first. Nothing for a target that has only that one.
std::optional<std::string> further_values_text(const std::vector<std::string>& observables,
                                               const std::vector<Observed>& observed);

// In the order of `observables`; without a value where the text has none of that name. Throws IntegrityError
// for what is no such text.
std::vector<Observation> further_values(const std::string& text, const std::vector<std::string>& observables);

}  // namespace peclet::runner
