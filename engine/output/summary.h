// What a result says in ten lines, for whoever sits before the terminal.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet::engine {

// Of a realisation that is complete: its means, each with its standard error within this run (of the block
// means, by their statistical inefficiency), its steps, warnings and cost, and `place`, where the result
// lies. Ends with a newline.
std::string summary(const Json& result, const std::string& place);

// The text of a result: the keys that tell which run it is and the means first, the long lists of blocks
// last. The order has no meaning to a reader of JSON, nor to canonical_json().
std::string result_text(const Json& result);

}  // namespace peclet::engine
