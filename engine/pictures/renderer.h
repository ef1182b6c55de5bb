// The stage in light: spheres and rods by scanline, each pixel from nine rays.
#pragma once

#include "engine/pictures/camera.h"
#include "engine/pictures/ink.h"

namespace peclet::engine {

// Draws over the canvas, from the same rays whatever the number of threads is.
void render(Canvas& canvas, const Stage& stage, const Camera& camera, int threads);

}  // namespace peclet::engine
