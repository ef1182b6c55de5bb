// What colours mean: a number of each sphere, or its species.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// Linear red, green and blue, 1 each for white; files hold sRGB (IEC 61966-2-1).
struct Colour {
  float red = 0, green = 0, blue = 0;

  friend Colour operator+(const Colour& a, const Colour& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
  }
  friend Colour operator*(float s, const Colour& a) { return {s * a.red, s * a.green, s * a.blue}; }
};

constexpr Colour white{1, 1, 1};

// So much of b, the rest of a.
inline Colour mixed(const Colour& a, const Colour& b, float share) { return (1 - share) * a + share * b; }

// From 0xRRGGBB of sRGB; of one number in [0, 1]; and back to 0 ... 255.
Colour colour_of(std::uint32_t rgb);
float linear_of(double encoded);
std::uint8_t encoded(float linear);

// The colour map viridis by S. van der Walt, N. Smith and E. Firing (published under CC0 with matplotlib),
// equal steps of which look equal. `place` is from 0 to 1, what lies outside of it is drawn as the end.
Colour viridis(double place);

// Eight colours that most people with a defect of colour vision tell apart: P. Tol, "Colour Schemes" (2021),
// scheme light. Requires species < count_of_species_colours.
constexpr std::size_t count_of_species_colours = 8;
Colour colour_of_species(std::size_t species);

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
