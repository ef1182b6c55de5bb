// Which sizes stand for a measured distribution, and how many spheres they take: the verb `peclet-engine
// sizes`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/scene/size_distribution.h"

namespace peclet::engine {

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
