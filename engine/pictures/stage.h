// What stands before the camera.
#pragma once

#include <vector>

#include "engine/pictures/colour.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

struct Ball {
  Vector3 centre;
  double radius;
  Colour colour;
};

// A cylinder with round ends.
struct Rod {
  Vector3 from, to;
  double radius;
  Colour colour;
};

struct Stage {
  std::vector<Ball> balls;
  std::vector<Rod> rods;
  // Seen through: each takes some light from what lies behind it, most at its rim.
  std::vector<Ball> glass;
};

}  // namespace peclet::engine
