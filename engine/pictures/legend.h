// Beside the spheres: what colours mean, the moment, and which way is which.
#pragma once

#include <string>

#include "engine/pictures/camera.h"
#include "engine/pictures/colouring.h"
#include "engine/pictures/ink.h"

namespace peclet::engine {

// Pixels; everything else follows from the height of the picture.
struct Layout {
  Layout(std::size_t width, std::size_t height);

  double width, height, margin, letters;
  // What the spheres have, and what is left of the right side.
  Frame spheres, legend;
};

void draw_legend(Canvas& canvas, const Layout& layout, const Colouring& colouring);
// At the lower left: x, y and z as the camera sees them; beside them a line of text.
void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& text);

}  // namespace peclet::engine
