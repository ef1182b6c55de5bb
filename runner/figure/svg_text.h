// Elements of SVG. Whatever is written as text is escaped.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "runner/figure/label.h"

namespace peclet::runner {

// Told apart in grey and by eyes that see few colours; those of the page on a light ground.
constexpr std::array<const char*, 8> figure_colours{"#0072b2", "#c44e00", "#00805c", "#a8487f",
                                                    "#b07700", "#3a8fc0", "#6b6b00", "#1b1b1b"};
constexpr std::size_t figure_shapes = 7;  // of marks; 56 curves differ in colour or mark

struct Place {
  double x = 0, y = 0;
};

// Tenths of a pixel.
std::string svg_number(double value);

std::string svg_line(Place from, Place to, const std::string& style);
std::string svg_path(const std::vector<Place>& places, bool closed, const std::string& style);

// The mark of the i-th curve; one that is hollow shows the ground.
std::string svg_mark(std::size_t curve, Place centre, bool hollow);
// The mark of what has jammed.
std::string svg_cross(std::size_t curve, Place centre);

enum class Anchor { start, middle, end };
std::string svg_text(const Label& label, Place at, Anchor anchor, int size = 14, bool upright = false);

// What text of that size is expected to take; fonts differ.
double text_width(const Label& label, int size = 14);

}  // namespace peclet::runner
