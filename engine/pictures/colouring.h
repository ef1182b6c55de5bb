// What colours mean: a number of each sphere, or its species.
#pragma once

#include <string>
#include <vector>

#include "engine/pictures/colour.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// The names of --colour.
const std::vector<std::string>& names_of_colourings();

// A scale from low to high, drawn as a bar.
struct ColourScale {
  std::string title;
  double low = 0, high = 1;

  Colour at(double value) const { return viridis((value - low) / (high - low)); }
};

// A scale over nearly all of the values: from the 2nd to the 98th percentile.
ColourScale scale_over(const std::string& title, std::vector<double> values);

// Round numbers on a scale, some five of them: 1, 2 or 5 times a power of ten apart.
std::vector<double> ticks_of(const ColourScale& scale);

struct NamedColour {
  std::string name;
  Colour colour;
};

// Of every sphere its colour, and what explains them: a scale or names.
struct Colouring {
  std::vector<Colour> of_spheres;
  std::vector<ColourScale> scale;  // one, or none
  std::vector<NamedColour> names;
};

// species, of more than eight their radii on a scale; speed: of the centre beyond the mean flow L r, L the
// velocity gradient of the file, or without it gamma y along x with gamma = strain / time, or in the
// laboratory where the file has neither; contacts: of a sphere; stress: sigma_xy, what the sphere adds to V
// sigma over its own volume. Throws InputError naming the file where the frame does not have what is asked
// for.
Colouring colouring_of(const Snapshot& snapshot, const std::string& name, const std::string& file);

}  // namespace peclet::engine
