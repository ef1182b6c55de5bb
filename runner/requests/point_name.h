// How people name a point on the command line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

// The index of the point of that label, or else of the only one with these values ("10 0.5", as in the row of
// a table) or with those 4 or more leading digits of its hash.
// Throws InputError for a name that no point, or more than one, has.
std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name);

}  // namespace peclet::runner
