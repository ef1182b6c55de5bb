// Measured sizes: a table as instruments save it, and the sizes that stand for it in a scene.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/size_distribution.h"

namespace peclet::engine {

// A table of sizes and shares, as instruments and spreadsheets save it.
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

// Which sizes stand for a measured distribution, and how many spheres they take: the verb `peclet-engine
// sizes`.
struct SizesOptions {
  std::string file;
  std::string sizes;      // "radius" or "diameter"
  std::string shares;     // "volume" or "number"
  std::string columns;    // "1,2": those of size and share; empty: the file has two
  std::size_t count = 0;  // spheres that are to do; 0: all sizes of the file are kept
};

// Text for standard output and for a person.
struct SizesAnswer {
  std::string block, remarks;
};

// Merges the size with the fewest spheres and the neighbour that has fewer: both together keep their number
// and volume, as the classes of a distribution do. Requires two sizes at least, ascending.
std::vector<SizeClass> with_one_size_less(std::vector<SizeClass> classes);

// Reads the file, merges thin sizes until each has one of `count` spheres, and writes the species of a scene.
// Throws InputError.
SizesAnswer choose_sizes(const SizesOptions& options);

}  // namespace peclet::engine
