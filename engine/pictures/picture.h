// Draws a frame of a trajectory: the verb `peclet-engine snapshot`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/pictures/colouring.h"
#include "engine/pictures/ink.h"
#include "engine/pictures/renderer.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// The layout of an image [pixels], which follows from its size.
struct Layout {
  Layout(std::size_t width, std::size_t height);

  double width, height, margin, letters;
  // The frame of the spheres, and that of the legend at the right side.
  Frame spheres, legend;
};

void draw_legend(Canvas& canvas, const Layout& layout, const Colouring& colouring);
// Draws x, y and z as the camera sees them at the bottom of the legend, and a line of text at its top.
void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& text);

struct PictureOptions {
  std::string file, output;
  std::int64_t frame = -1;
  std::optional<std::string> frames{};  // of a film, as in chosen_frames(); else a single picture
  std::string view = "corner", size = "1600x1200", colour = "species";
  bool chains = false;
  int threads = 1;
};

// The common part of all pictures of a film: bounds of the stages of all of them, and the scale of colours,
// if they have one.
struct FilmFraming {
  Stage bounds;
  std::vector<ColourScale> scale;
};

// Writes a PNG file. Returns a note for the user, or an empty text. Throws InputError or std::system_error.
std::string draw_picture(const PictureOptions& options);

// Reads a line of sight: "corner", "x", "y", "z", or "AZIMUTH,ELEVATION" in degrees. Throws InputError.
View view_named(const std::string& name);

// Returns the image, which may be one of a film. Throws InputError, naming `options.file`, if the frame lacks
// numbers for the colours.
Image picture_of(const Snapshot& snapshot, const PictureOptions& options, const FilmFraming* film = nullptr);

}  // namespace peclet::engine
