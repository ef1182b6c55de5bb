#include "engine/pictures/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace peclet::engine {
namespace {

// Balls that hold everything: the balls and both ends of the rods.
template <class Visit>
void for_each_bound(const Stage& stage, const Visit& visit) {
  for (const Ball& ball : stage.balls) visit(ball.centre, ball.radius);
  for (const Ball& ball : stage.glass) visit(ball.centre, ball.radius);
  for (const Rod& rod : stage.rods) {
    visit(rod.from, rod.radius);
    visit(rod.to, rod.radius);
  }
}

}  // namespace

Camera::Camera(const Stage& stage, const View& view, const Frame& frame) {
  constexpr double degree = std::numbers::pi / 180, distance = 6;
  const double a = view.azimuth * degree, e = view.elevation * degree;
  const Vector3 towards_eye = {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
  forward_ = -towards_eye;
  right_ = {std::cos(a), 0, -std::sin(a)};
  up_ = cross(right_, forward_);
  constexpr double far = std::numeric_limits<double>::infinity();
  Vector3 low = {far, far, far}, high = {-far, -far, -far};
  for_each_bound(stage, [&](const Vector3& c, double r) {
    low = {std::min(low.x, c.x - r), std::min(low.y, c.y - r), std::min(low.z, c.z - r)};
    high = {std::max(high.x, c.x + r), std::max(high.y, c.y + r), std::max(high.z, c.z + r)};
  });
  eye_ = 0.5 * (low + high) + (distance * 0.5 * norm(high - low)) * towards_eye;
  Reach all{far, -far, far, -far};
  for_each_bound(stage, [&](const Vector3& c, double r) {
    const Reach one = reach_of(seen(c), r);
    all = {std::min(all.low_u, one.low_u), std::max(all.high_u, one.high_u), std::min(all.low_v, one.low_v),
           std::max(all.high_v, one.high_v)};
  });
  scale_ = std::min((frame.right - frame.left) / (all.high_u - all.low_u),
                    (frame.bottom - frame.top) / (all.high_v - all.low_v));
  left_ = 0.5 * (frame.left + frame.right) - scale_ * 0.5 * (all.low_u + all.high_u);
  top_ = 0.5 * (frame.top + frame.bottom) + scale_ * 0.5 * (all.low_v + all.high_v);
}

Vector3 Camera::turned(const Vector3& d) const { return {dot(right_, d), dot(up_, d), dot(forward_, d)}; }
Vector3 Camera::seen(const Vector3& place) const { return turned(place - eye_); }

Stage Camera::seen(const Stage& stage) const {
  Stage all = stage;
  for (Ball& ball : all.balls) ball.centre = seen(ball.centre);
  for (Ball& ball : all.glass) ball.centre = seen(ball.centre);
  for (Rod& rod : all.rods) {
    rod.from = seen(rod.from);
    rod.to = seen(rod.to);
  }
  return all;
}

// Tangents from the eye: (c_x c_z -+ r sqrt(c_x^2 + c_z^2 - r^2)) / (c_z^2 - r^2).
Reach reach_of(const Vector3& c, double r) {
  const double below = c.z * c.z - r * r;
  const double u = r * std::sqrt(c.x * c.x + below), v = r * std::sqrt(c.y * c.y + below);
  return {(c.x * c.z - u) / below, (c.x * c.z + u) / below, (c.y * c.z - v) / below, (c.y * c.z + v) / below};
}

}  // namespace peclet::engine
