// Light on surfaces: a bright sky, a lamp from the upper left, and air that takes colour with the distance.
#pragma once

#include "engine/pictures/camera.h"

namespace peclet::engine {

class Light {
 public:
  // Of a stage as the camera sees it.
  Light(const Camera& camera, const Stage& seen);

  // What reaches the eye from a place of that normal, of whose sky a share is free.
  Colour on(const Colour& surface, const Vector3& place, const Vector3& normal, double free_sky) const;

  // The colour of glass, and the share of the light behind it that it takes where ray and surface have that
  // cosine: more towards the rim.
  const Colour& glass() const { return glass_; }
  static double veil(double cosine);

 private:
  Vector3 lamp_, up_;
  double near_ = 0, depth_ = 1;
  Colour glass_;
};

}  // namespace peclet::engine
