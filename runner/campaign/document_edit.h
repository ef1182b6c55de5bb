// One value of a JSON text replaced, and nothing else: the author's order, blanks and spelling stay.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

// The text in which the value at `path` (keys of nested objects, all but the last of which must exist) is
// `value`: its token is replaced, or the key is put behind the last one of its object, spaced as the first
// one is. Requires a text that parse_json() has read.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const Json& value);

}  // namespace peclet::runner
