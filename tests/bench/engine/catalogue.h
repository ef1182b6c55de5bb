// The named cases of the benchmark.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace peclet::engine {

// A scene on some threads, enlarged `tiles`-fold along each edge after packing and shearing.
struct Contestant {
  std::string name, meaning;
  Scene scene;
  int tiles = 1;
  int threads = 1;
};

// Contestants that are measured in alternation, so that each ratio to the first one is from one moment.
struct Group {
  std::string name, question;
  std::vector<Contestant> contestants;
  int rounds = 41;
};

// Returns the groups that `names` select: all if empty; a group, or contestants of it, by name. Throws
// InputError for a name that is not in the catalogue.
std::vector<Group> chosen_groups(const std::vector<std::string>& names);

}  // namespace peclet::engine
