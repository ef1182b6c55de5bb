#include "tests/engine/every_image.h"

#include <algorithm>
#include <tuple>

namespace peclet::engine {
namespace {

struct Whole {
  std::int32_t first, last;
};

// Returns the range of all k with |distance + k length| <= range.
Whole within(double distance, double length, double range) {
  return {static_cast<std::int32_t>(std::ceil((-range - distance) / length)),
          static_cast<std::int32_t>(std::floor((range - distance) / length))};
}

}  // namespace

std::vector<SeenPair> every_image(const VectorField& position, const Vector3& lengths, double tilt,
                                  const std::function<double(std::uint32_t, std::uint32_t)>& range) {
  std::vector<SeenPair> seen;
  const auto count = static_cast<std::uint32_t>(position.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) {
      const Vector3 d = position[j] - position[i];
      const double reach = range(i, j);
      const Whole in_z = within(d.z, lengths.z, reach), in_y = within(d.y, lengths.y, reach);
      for (std::int32_t kz = in_z.first; kz <= in_z.last; ++kz) {
        for (std::int32_t ky = in_y.first; ky <= in_y.last; ++ky) {
          const Whole in_x = within(d.x + ky * tilt, lengths.x, reach);
          for (std::int32_t kx = in_x.first; kx <= in_x.last; ++kx) {
            const Vector3 r = d + Vector3{kx * lengths.x + ky * tilt, ky * lengths.y, kz * lengths.z};
            if (dot(r, r) < reach * reach) {
              seen.push_back({i, j, {kx, ky, kz}, r});
            }
          }
        }
      }
    }
  }
  std::sort(seen.begin(), seen.end(), [](const SeenPair& a, const SeenPair& b) {
    return std::tie(a.first, a.second, a.image) < std::tie(b.first, b.second, b.image);
  });
  return seen;
}

std::size_t count_near(const System& system, double factor) {
  const std::vector<double>& radius = system.particles.radius;
  const auto range = [&](std::uint32_t i, std::uint32_t j) { return factor * (radius[i] + radius[j]); };
  return every_image(system.particles.position, system.box.lengths(), system.box.tilt(), range).size();
}

}  // namespace peclet::engine
