// Renders spheres and rods by scanline, with nine rays for each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/pictures/colouring.h"
#include "engine/pictures/ink.h"
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
  // Transparent balls: each takes some of the light from behind, most at its rim.
  std::vector<Ball> glass;
};

// The part of an image [pixels] that the stage is fitted into.
struct Frame {
  double left, top, right, bottom;
};

// The direction of the eye [degrees]: azimuth about y from z towards x, and elevation above the xz plane.
struct View {
  double azimuth, elevation;
};

// A camera. In its coordinates x is to the right, y upwards and z away from the eye, which is at the origin.
class Camera {
 public:
  // Looks at the middle of the stage from six times its half width, and fits it into the frame. Requires a
  // stage that is not empty.
  Camera(const Stage& stage, const View& view, const Frame& frame);

  Vector3 seen(const Vector3& place) const;
  // Returns a direction, such as that of light, in the coordinates of the camera.
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

// The extent of a ball along u and v. Requires that the eye is outside.
struct Reach {
  double low_u, high_u, low_v, high_v;
};
Reach reach_of(const Vector3& centre, double radius);

// Soft shade in gaps: near neighbours of each ball cover some of its sky.
class Occlusion {
 public:
  explicit Occlusion(const std::vector<Ball>& balls);

  // Returns the free share of the sky over a place with this normal on the surface of a ball: the product
  // over its neighbours of 1 - c. A cap c above the horizon, weighted with the cosine, is (n . d) a^2 / r^2.
  double free_sky(std::uint32_t ball, const Vector3& place, const Vector3& normal) const;

 private:
  struct Neighbour {
    Vector3 centre;
    double square;  // square of its radius
  };
  std::vector<std::uint32_t> begin_;  // first neighbour of each ball, and the end
  std::vector<Neighbour> neighbours_;
};

// Draws the stage over the canvas. The image does not depend on the number of threads.
void render(Canvas& canvas, const Stage& stage, const Camera& camera, int threads);

}  // namespace peclet::engine
