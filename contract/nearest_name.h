// What somebody may have meant who mistyped a name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace peclet {

// The name that `typed` becomes with the fewest wrong, missing, added or swapped letters; the first of
// several;
// "" when each needs more of them than a third of its letters (at least one), so that nothing far-fetched is
// offered.
std::string nearest_name(std::string_view typed, const std::vector<std::string>& names);

// "; did you mean NAME?", or nothing when there is no such name.
std::string suggestion(std::string_view typed, const std::vector<std::string>& names);

}  // namespace peclet
