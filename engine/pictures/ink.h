// Lines and letters on a finished picture, with smooth edges.
#pragma once

#include <string_view>
#include <vector>

#include "engine/pictures/colour.h"
#include "engine/pictures/png.h"

namespace peclet::engine {

// A picture in linear light, row after row from the top. Places are in pixels; the first one is [0, 1) x [0,
// 1).
struct Canvas {
  Canvas(std::size_t w, std::size_t h) : width(w), height(h), pixel(w * h, white) {}

  Colour& at(std::size_t x, std::size_t y) { return pixel[y * width + x]; }
  Image image() const;

  std::size_t width, height;
  std::vector<Colour> pixel;
};

struct Spot {
  double x, y;
};

// A stroke with round ends.
void draw_line(Canvas& canvas, Spot from, Spot to, double width, const Colour& colour);
void draw_disc(Canvas& canvas, Spot centre, double radius, const Colour& colour);
// Edges on whole pixels are sharp.
void draw_box(Canvas& canvas, Spot corner, Spot opposite, const Colour& colour);

// Width of a line of text whose capitals are so high; characters other than ASCII are drawn as "?".
double width_of_text(std::string_view text, double height);
// `line` is where the line of the text begins.
void draw_text(Canvas& canvas, Spot line, double height, std::string_view text, const Colour& colour);

}  // namespace peclet::engine
