#include "engine/output/final_configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <vector>

namespace peclet::engine {
namespace {

std::string spaced(const Vector3& vector) { return fmt::format("{} {} {}", vector.x, vector.y, vector.z); }

}  // namespace

std::string extended_xyz(const System& system) {
  const ParticleState& particles = system.particles;
  std::vector<std::size_t> order(particles.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return particles.id[i] < particles.id[j]; });
  const auto &edges = system.box.edges().column, &gradient = system.box.velocity_gradient().column;
  std::string text = fmt::format(
      "{}\nLattice=\"{} {} {}\" Properties=id:I:1:pos:R:3:radius:R:1:velo:R:3:angular_velocity:R:3 pbc=\"T T "
      "T\" Time={} Strain={} Velocity_gradient=\"{} {} {}\"\n",
      particles.count(), spaced(edges[0]), spaced(edges[1]), spaced(edges[2]), system.clock.time(),
      system.box.net_strain(), spaced(gradient[0]), spaced(gradient[1]), spaced(gradient[2]));
  for (const std::size_t i : order) {
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", particles.id[i],
                   spaced(particles.position[i]), particles.radius[i], spaced(particles.velocity[i]),
                   spaced(particles.angular_velocity[i]));
  }
  return text;
}

}  // namespace peclet::engine
