#include "engine/observables/velocity_variance.h"

#include <cmath>

namespace peclet::engine {
namespace {

std::size_t slabs_of(double width, double reference_radius) {
  return static_cast<std::size_t>(std::ceil(width / (0.2 * reference_radius) - 1e-9));
}

double excess(double square, double sum, double samples) { return square - sum * sum / samples; }

}  // namespace

VelocityVariance::VelocityVariance(double height, double reference_radius, std::size_t bins)
    : height_(height),
      bins_(bins),
      slabs_of_bin_(slabs_of(height / static_cast<double>(bins), reference_radius)),
      samples_(bins_ * slabs_of_bin_),
      sums_(samples_.size()),
      squares_(samples_.size()) {}

void VelocityVariance::add(const Vector3& place, const Vector3& velocity) {
  const double k = std::floor(place.y / height_ * static_cast<double>(samples_.size()));
  const std::size_t slab = periodic_bin(static_cast<std::int64_t>(k), samples_.size());
  ++samples_[slab];
  sums_[slab] += velocity;
  squares_[slab] += {velocity.x * velocity.x, velocity.y * velocity.y, velocity.z * velocity.z};
}

Json VelocityVariance::value() const {
  Json rows = {Json::array(), Json::array(), Json::array()};
  for (std::size_t bin = 0; bin < bins_; ++bin) {
    Vector3 left{};
    double degrees = 0;
    for (std::size_t k = bin * slabs_of_bin_; k < (bin + 1) * slabs_of_bin_; ++k) {
      const double n = samples_[k];
      if (n < 2) continue;
      degrees += n - 1;
      left += {excess(squares_[k].x, sums_[k].x, n), excess(squares_[k].y, sums_[k].y, n),
               excess(squares_[k].z, sums_[k].z, n)};
    }
    const double components[] = {left.x, left.y, left.z};
    for (std::size_t c = 0; c < 3; ++c)
      rows[c].push_back(degrees > 0 ? Json(components[c] / degrees) : Json());
  }
  return rows;
}

}  // namespace peclet::engine
