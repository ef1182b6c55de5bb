#include "engine/pictures/lighting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace peclet::engine {

Light::Light(const Camera& camera, const Stage& seen) : glass_(colour_of(0x8fa3b8)) {
  constexpr Vector3 towards_lamp = {-0.45, 0.75, -0.6};  // over the eye's left shoulder
  lamp_ = (1 / norm(towards_lamp)) * towards_lamp;
  up_ = camera.turned({0, 1, 0});
  double near = std::numeric_limits<double>::infinity(), far = -near;
  const auto take = [&](double z) {
    near = std::min(near, z);
    far = std::max(far, z);
  };
  for (const Ball& ball : seen.balls) take(ball.centre.z);
  for (const Ball& ball : seen.glass) take(ball.centre.z);
  near_ = near;
  depth_ = std::max(far - near, std::numeric_limits<double>::min());
}

Colour Light::on(const Colour& surface, const Vector3& place, const Vector3& normal, double free_sky) const {
  const Vector3 to_eye = (-1 / norm(place)) * place;
  const double facing = std::max(0.0, dot(normal, to_eye));
  const double sky = (0.50 + 0.28 * dot(normal, up_)) * free_sky;
  // The lamp is wide: it reaches around the edge, and gaps between spheres are in its shade, too.
  const double lamp = std::max(0.0, (dot(normal, lamp_) + 0.25) / 1.25) * (0.25 + 0.75 * free_sky);
  const Vector3 half = lamp_ + to_eye;
  const double gloss = std::pow(std::max(0.0, dot(normal, half) / norm(half)), 60) * 0.16 * free_sky;
  const double rim = 0.72 + 0.28 * std::sqrt(facing);
  Colour colour = static_cast<float>((sky + 0.62 * lamp) * rim) * surface;
  colour = colour + static_cast<float>(gloss) * white;
  const double air = 0.34 * std::clamp((place.z - near_) / depth_, 0.0, 1.0);
  return mixed(colour, white, static_cast<float>(air));
}

double Light::veil(double cosine) {
  const double rim = 1 - cosine;
  return 0.008 + 0.30 * rim * rim * rim * rim;
}

}  // namespace peclet::engine
