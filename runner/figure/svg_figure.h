// A figure as a picture that needs no other program.
#pragma once

#include <string>

#include "runner/figure/figure.h"

namespace peclet::runner {

// One SVG document: ticks on all four sides, marks with bars, lines that guide the eye, and what the marks
// mean in a corner that is free, or beside the frame where none is. Colours and marks are those of the page.
std::string svg_figure(const Figure& figure);

// What the picture decides, for those who draw the same otherwise.
struct FigureLayout {
  Axis x, y;
  std::string legend;  // its place: "upper left", "upper right", "lower right", "lower left"; "beside"
};
FigureLayout figure_layout(const Figure& figure);

}  // namespace peclet::runner
