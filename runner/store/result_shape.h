// What a result must be before anything of it is stored: schema/result.schema.json, as far as the runner
// reads it.
//
// Results come from outside: an engine may lie, and a file may have been put where results are looked for.
// Whatever is wrong with one is found here, in one go and without a trace; who takes a result that has passed
// need not ask again.
#pragma once

#include <stdexcept>
#include <string>

#include "contract/json.h"
#include "runner/store/result_bounds.h"

namespace peclet::runner {

// A text that is no result. What it says is one short line, whatever the text holds.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(const std::string& message);
};

// No number of a result is larger: so no sum, square or cube of a campaign's values overflows.
constexpr double largest_number = 1e100;

// Throws ResultError naming the first value that is not as it must be, and what is allowed. Realisations
// with results have means, others none. Members that engines did not always write may be absent. Returns
// engine_identity().
std::string check_shape(const Json& document);

// Engine version, instruction set and hash of the binary: results of one point share it.
// Throws ResultError when one of the three is missing or none.
std::string engine_identity(const Json& engine);

}  // namespace peclet::runner
