// The named cases of the benchmark.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace peclet::engine {

// One scene, on some threads, `tiles` times as large along each edge as what is packed and sheared.
struct Contestant {
  std::string name, meaning;
  Scene scene;
  int tiles = 1;
  int threads = 1;
};

// Measured in alternation, so that each ratio to the first one is from the same moments.
struct Group {
  std::string name, question;
  std::vector<Contestant> contestants;
  int rounds = 41;
};

// The groups that `names` ask for: all without a name; a group, or contestants of it, by name.
// Throws InputError for a name that is not in the catalogue.
std::vector<Group> chosen_groups(const std::vector<std::string>& names);

}  // namespace peclet::engine
