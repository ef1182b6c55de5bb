// The stage in light: spheres and rods by scanline, each pixel from nine rays.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/pictures/colouring.h"
#include "engine/pictures/ink.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// What stands before the camera.
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

// The neighbours of each ball, so near that they take some of its sky: the soft shade in gaps.
class Occlusion {
 public:
  explicit Occlusion(const std::vector<Ball>& balls);

  // The free share of the sky over a place with that normal on the surface of a ball: the product over its
  // neighbours of 1 less the share of the sphere's cap, weighted with the cosine, (n . d) a^2 / r^2 for those
  // that the horizon does not cut.
  double free_sky(std::uint32_t ball, const Vector3& place, const Vector3& normal) const;

 private:
  struct Neighbour {
    Vector3 centre;
    double square;  // of its radius
  };
  std::vector<std::uint32_t> begin_;  // of each ball's neighbours, and the end
  std::vector<Neighbour> neighbours_;
};

// Draws over the canvas, from the same rays whatever the number of threads is.
void render(Canvas& canvas, const Stage& stage, const Camera& camera, int threads);

}  // namespace peclet::engine
