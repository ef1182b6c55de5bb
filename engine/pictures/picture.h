// A frame as a picture: the verb `peclet-engine snapshot`.
#pragma once

#include <string>

#include "engine/pictures/camera.h"
#include "engine/pictures/png.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

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
