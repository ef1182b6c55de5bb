// A frame as a picture: the verb `peclet-engine snapshot`.
#pragma once

#include <string>

#include "engine/pictures/colouring.h"
#include "engine/pictures/ink.h"
#include "engine/pictures/renderer.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// The parts of a picture in pixels; everything else follows from the height of the picture.
struct Layout {
  Layout(std::size_t width, std::size_t height);

  double width, height, margin, letters;
  // What the spheres have, and what is left of the right side.
  Frame spheres, legend;
};

void draw_legend(Canvas& canvas, const Layout& layout, const Colouring& colouring);
// At the lower left: x, y and z as the camera sees them; beside them a line of text.
void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& text);

struct PictureOptions {
  std::string file, output;
  std::int64_t frame = -1;
  std::string view = "corner", size = "1600x1200", colour = "species";
  bool chains = false;
  int threads = 1;
};

// Writes a PNG file. Returns what there is to say of the frame, if anything. Throws InputError,
// std::system_error.
std::string draw_picture(const PictureOptions& options);

// "corner", "x", "y" or "z", along which one looks, or "AZIMUTH,ELEVATION" in degrees. Throws InputError.
View view_named(const std::string& name);

// The picture itself. Colours that the frame has no numbers for: InputError naming `options.file`.
Image picture_of(const Snapshot& snapshot, const PictureOptions& options);

}  // namespace peclet::engine
