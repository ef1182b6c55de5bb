// Colours spheres by species or by a number, and describes the colours for a legend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// A colour in linear red, green and blue, 1 each for white; files hold sRGB (IEC 61966-2-1).
struct Colour {
  float red = 0, green = 0, blue = 0;

  friend Colour operator+(const Colour& a, const Colour& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
  }
  friend Colour operator*(float s, const Colour& a) { return {s * a.red, s * a.green, s * a.blue}; }
};

constexpr Colour white{1, 1, 1};

// Returns a mixture with this share of b.
inline Colour mixed(const Colour& a, const Colour& b, float share) { return (1 - share) * a + share * b; }

// Convert 0xRRGGBB of sRGB, or one of its numbers in [0, 1], to linear light, and back to 0 ... 255.
Colour colour_of(std::uint32_t rgb);
float linear_of(double encoded);
std::uint8_t encoded(float linear);

// Returns a colour of the map viridis by S. van der Walt, N. Smith and E. Firing (published under CC0 with
// matplotlib), on which equal steps look equal. `place` is cut to [0, 1].
Colour viridis(double place);

// Eight colours that most people with impaired colour vision can distinguish: P. Tol, "Colour Schemes"
// (2021), scheme light. Requires species < count_of_species_colours.
constexpr std::size_t count_of_species_colours = 8;
Colour colour_of_species(std::size_t species);

// Returns the values of the option --colour.
const std::vector<std::string>& names_of_colourings();

// A scale from low to high, drawn as a bar.
struct ColourScale {
  std::string title;
  double low = 0, high = 1;

  Colour at(double value) const { return viridis((value - low) / (high - low)); }
};

// Returns a scale from the 2nd to the 98th percentile of the values.
ColourScale scale_over(const std::string& title, std::vector<double> values);

// Returns about five round numbers on a scale, 1, 2 or 5 times a power of ten apart.
std::vector<double> ticks_of(const ColourScale& scale);

struct NamedColour {
  std::string name;
  Colour colour;
};

// The colour of each sphere, and the legend: a scale or names.
struct Colouring {
  std::vector<Colour> of_spheres;
  std::vector<ColourScale> scale;  // at most one
  std::vector<NamedColour> names;
};

// Returns the colours of the spheres by one of these names:
//   species   species; radius on a scale if there are more than eight species
//   speed     speed of the centre relative to the mean flow L r
//   contacts  number of contacts
//   stress    sigma_xy: the sphere's part of V sigma over its own volume
// L is the velocity gradient of the file, or that of simple shear at the rate strain / time, or 0. A scale
// that is `given` replaces that of the frame. Throws InputError, naming the
// file, if the frame lacks the numbers.
Colouring colouring_of(const Snapshot& snapshot, const std::string& name, const std::string& file,
                       const std::vector<ColourScale>& given = {});

}  // namespace peclet::engine
