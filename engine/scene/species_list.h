// A list of sizes in a scene, each a radius or a distribution of radii.
#pragma once

#include <string>
#include <vector>

#include "engine/document/keys.h"
#include "engine/document/scene_document.h"
#include "engine/scene/composition.h"

namespace peclet::engine {

// Each pair of sizes has constants of its own.
inline constexpr std::size_t most_species = 256;

// Of the elements of the list at `pointer`.
Keys species_keys(const std::string& pointer);

struct SpeciesList {
  Particles::Shares shares = Particles::Shares::volume;
  std::vector<Species> species;       // shares add up to 1
  std::vector<std::string> pointers;  // of each species, to the element that it comes from
  bool distributed = false;           // some come from a distribution
};

// Throws InputError where elements do not go together.
SpeciesList read_species(const SceneDocument& scene, const std::string& pointer);

}  // namespace peclet::engine
