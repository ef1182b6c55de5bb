// A table of sizes and shares, as instruments and spreadsheets save it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace peclet::engine {

struct MeasuredSize {
  double size, share;
};

// Reads lines of a size and its share; returns the sizes with a share > 0, ascending. Fields are parted by
// semicolons, tabs, blanks or commas, whichever comes first in this order in the lines of numbers; beside
// another separator a comma is that of a decimal fraction. Lines above the first number are a header.
// `columns` names those of size and share, from 1. Throws InputError naming `file` and the line if a line of
// numbers has other columns than two and these are {0, 0}, a size is not > 0 or there twice, a share is
// negative, or shares are those of a cumulative curve.
std::vector<MeasuredSize> measured_sizes(std::string_view text, const std::string& file,
                                         std::pair<std::size_t, std::size_t> columns = {0, 0});

}  // namespace peclet::engine
