// From places to pixels, in weak perspective.
#pragma once

#include <cstddef>

#include "engine/pictures/stage.h"

namespace peclet::engine {

// The part of a picture, in pixels, into which everything is to fit.
struct Frame {
  double left, top, right, bottom;
};

// From where one looks: degrees about y, from z towards x, and upwards from the plane of x and z.
struct View {
  double azimuth, elevation;
};

// Coordinates of the camera: x to the right, y upwards, z away from the eye, which is at the origin.
class Camera {
 public:
  // Looks at the middle of the stage from six times its half width, and fits it into the frame. Requires a
  // stage that is not empty.
  Camera(const Stage& stage, const View& view, const Frame& frame);

  Vector3 seen(const Vector3& place) const;
  // A direction that has no place, such as that of light.
  Vector3 turned(const Vector3& direction) const;
  Stage seen(const Stage& stage) const;

  // A point at u = x/z, v = y/z is at the pixel left + scale u, top - scale v.
  double scale() const { return scale_; }
  double left() const { return left_; }
  double top() const { return top_; }

 private:
  Vector3 right_, up_, forward_, eye_;
  double scale_ = 1, left_ = 0, top_ = 0;
};

// How far a ball reaches along u and v as the camera sees it. Requires that the eye is outside.
struct Reach {
  double low_u, high_u, low_v, high_v;
};
Reach reach_of(const Vector3& centre, double radius);

}  // namespace peclet::engine
