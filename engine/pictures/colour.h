// Colours of pictures. Light adds up in linear numbers; files hold sRGB (IEC 61966-2-1).
#pragma once

#include <cstddef>
#include <cstdint>

namespace peclet::engine {

// Linear red, green and blue, 1 each for white.
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

}  // namespace peclet::engine
