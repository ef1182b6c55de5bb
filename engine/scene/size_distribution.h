// SizeDistribution is a distribution of radii; size_classes() gives the few sizes that represent it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/flow/scene_document.h"
#include "engine/scene/composition.h"

namespace peclet::engine {

// A distribution of radii a has a mean m and a relative width c, the standard deviation over the mean. Both
// are weighted by number, or `by_volume` by a^3.
//   lognormal  ln a is Gaussian, with the variance ln(1 + c^2)
//   uniform    between m (1 - sqrt(3) c) and m (1 + sqrt(3) c)
//   gaussian   cut off at three standard deviations; c is the width after the cut
struct SizeDistribution {
  enum class Form { lognormal, uniform, gaussian };
  Form form = Form::lognormal;
  double mean_radius = 0, relative_width = 0;
  bool by_volume = false;
  std::size_t classes = 0;
};

// Returns the largest relative width: 1 for a lognormal distribution. Wider uniform or Gaussian ones would
// have radii near 0.
double largest_relative_width(SizeDistribution::Form form);

// SizeClass is a size that represents a part of the spheres.
struct SizeClass {
  double radius;
  double number;  // share in the number of all spheres
};

// Returns the sizes that represent a distribution, ascending. Cuts are where the mean of the shares of number
// and volume below a radius is k / classes. No class has more than 2 / classes of either. A class has the
// number and the volume of the spheres in its part, hence the radius (volume / number)^(1/3), rounded to six
// digits. This keeps the mean of a^3. The means of a and a^2 are too large by less than 0.5 % with 16 classes
// and widths up to 0.5. Requires a width in (0, largest_relative_width].
std::vector<SizeClass> size_classes(const SizeDistribution& distribution);

// The largest number of sizes. Each pair of sizes has its own constants.
inline constexpr std::size_t most_species = 256;

// Returns the rows of an element of /particles/species and of the lists of a mixture.
std::string species_keys();

struct SpeciesList {
  Particles::Shares shares = Particles::Shares::volume;
  std::vector<Species> species;       // shares add up to 1
  std::vector<std::string> pointers;  // the element that each species comes from
  bool distributed = false;           // true if some species come from a distribution
};

// Reads species at this pointer and divides shares by their sum. Throws InputError if they disagree.
SpeciesList read_species(const SceneDocument& scene, const std::string& pointer);

}  // namespace peclet::engine
