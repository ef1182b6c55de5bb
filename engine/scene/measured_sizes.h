// measured_sizes() reads a table as instruments save it; choose_sizes() turns it into species of a scene.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/size_distribution.h"

namespace peclet::engine {

struct MeasuredSize {
  double size, share;  // radius or diameter, and the share of it
};

// Reads lines of a size and its share. Returns the sizes with a share > 0, ascending. Lines above the first
// number are a header. `columns` are those of size and share, from 1; {0, 0} if the table has two.
//
// The separator is the first of semicolon, tab, blank and comma that separates numbers in some line. A comma
// beside another separator is a decimal comma. Throws InputError naming `file` and the line: columns are
// missing or not named, a size is not > 0 or occurs twice, a share is negative, or shares are cumulative.
std::vector<MeasuredSize> measured_sizes(std::string_view text, const std::string& file,
                                         std::pair<std::size_t, std::size_t> columns = {0, 0});

// SizesOptions are those of the verb `peclet-engine sizes`.
struct SizesOptions {
  std::string file;
  std::string sizes;      // "radius" or "diameter"
  std::string shares;     // "volume" or "number"
  std::string columns;    // "1,2": columns of size and share; empty: the file has two
  std::size_t count = 0;  // largest number of spheres; 0: all sizes of the file are kept
};

// Keys of a scene, written for its user.
struct WrittenKeys {
  std::string block, remarks;  // text for standard output, and for a person
};

// Merges the size with the fewest spheres and that neighbour which has fewer. The new size has the number and
// the volume of both. Requires at least two sizes, ascending.
std::vector<SizeClass> with_one_size_less(std::vector<SizeClass> classes);

// Reads the file, merges sizes until each has one of `count` spheres, and writes the species of a scene, with
// their mean radius by number as radius of reference.
// Throws InputError.
WrittenKeys choose_sizes(const SizesOptions& options);

}  // namespace peclet::engine
