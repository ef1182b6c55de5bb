// Distributions of radii, and the few sizes that stand for them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/flow/scene_document.h"
#include "engine/scene/composition.h"

namespace peclet::engine {

// A distribution of radii a by its mean m and its relative width c, the standard deviation over the mean.
// Both are those of the spheres' number, or by volume those of their volume, in which a sphere counts
// a^3-fold:
//   lognormal: ln a is Gaussian, of variance ln(1 + c^2);
//   uniform: between m (1 - sqrt(3) c) and m (1 + sqrt(3) c);
//   gaussian: cut off at three of its standard deviations; c is that of what is left.
struct SizeDistribution {
  enum class Form { lognormal, uniform, gaussian };
  Form form = Form::lognormal;
  double mean_radius = 0, relative_width = 0;
  bool by_volume = false;
  std::size_t classes = 0;
};

// Beyond this relative width a uniform or Gaussian distribution would have radii of 0 or less, or nearly;
// that of a lognormal one is 1.
double largest_relative_width(SizeDistribution::Form form);

// A size that stands for a part of the spheres.
struct SizeClass {
  double radius;
  double number;  // share of the number of all spheres
};

// The sizes of a distribution, ascending, always the same ones: it is cut where the mean of its shares of
// number and volume below a radius is k / classes, so that no class has more than twice that part of either.
// A class has the number and the volume of the spheres in its part, hence the radius (volume / number)^(1/3),
// rounded to six digits. The mean of a^3 of all spheres is therefore kept; those of a and a^2 are too large
// by less than 0.5 % with 16 classes and widths up to 0.5. Requires a width in (0, largest_relative_width].
std::vector<SizeClass> size_classes(const SizeDistribution& distribution);

// Each pair of sizes has constants of its own.
inline constexpr std::size_t most_species = 256;

// Rows of the elements of /particles/species, which those of a mixture's lists share.
std::string species_keys();

struct SpeciesList {
  Particles::Shares shares = Particles::Shares::volume;
  std::vector<Species> species;       // shares add up to 1
  std::vector<std::string> pointers;  // of each species, to the element that it comes from
  bool distributed = false;           // some come from a distribution
};

// Throws InputError where elements do not go together.
SpeciesList read_species(const SceneDocument& scene, const std::string& pointer);

}  // namespace peclet::engine
