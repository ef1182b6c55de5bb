#include "engine/pictures/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace peclet::engine {
namespace {

// Gaps over the larger radius beyond which a neighbour's cap is too small to be seen.
constexpr double reach = 1.2;

using Box = std::array<std::int64_t, 3>;

}  // namespace

Occlusion::Occlusion(const std::vector<Ball>& balls) {
  double largest = 0;
  for (const Ball& ball : balls) largest = std::max(largest, ball.radius);
  const double edge = (2 + reach) * largest;
  const auto box_of = [edge](const Vector3& c) {
    const auto part = [edge](double x) { return static_cast<std::int64_t>(std::floor(x / edge)); };
    return Box{part(c.x), part(c.y), part(c.z)};
  };
  std::map<Box, std::vector<std::uint32_t>> boxes;
  for (std::uint32_t i = 0; i < balls.size(); ++i) boxes[box_of(balls[i].centre)].push_back(i);
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    begin_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    const Ball& ball = balls[i];
    const Box middle = box_of(ball.centre);
    for (int place = 0; place < 27; ++place) {
      const auto found =
          boxes.find({middle[0] + place % 3 - 1, middle[1] + place / 3 % 3 - 1, middle[2] + place / 9 - 1});
      if (found == boxes.end()) continue;
      for (const std::uint32_t j : found->second) {
        const double gap = norm(balls[j].centre - ball.centre) - ball.radius - balls[j].radius;
        if (j == i || gap > reach * std::max(ball.radius, balls[j].radius)) continue;
        neighbours_.push_back({balls[j].centre, balls[j].radius * balls[j].radius});
      }
    }
  }
  begin_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
}

double Occlusion::free_sky(std::uint32_t ball, const Vector3& place, const Vector3& normal) const {
  double free = 1;
  for (std::uint32_t k = begin_[ball]; k < begin_[ball + 1]; ++k) {
    const Vector3 apart = neighbours_[k].centre - place;
    const double square = dot(apart, apart), cap = neighbours_[k].square / square;
    const double cosine = dot(normal, apart) / std::sqrt(square);
    // Where the horizon cuts the cap, between +-sine, a parabola joins what is whole to nothing.
    const double sine = std::sqrt(std::min(cap, 1.0));
    const double seen = cosine >= sine    ? cosine
                        : cosine <= -sine ? 0
                                          : (cosine + sine) * (cosine + sine) / (4 * sine);
    free *= 1 - std::min(1.0, seen * cap);
  }
  return free;
}

}  // namespace peclet::engine
