#include "engine/realisation/scene_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "contract/input_error.h"
#include "engine/kernels/pairs/pair_kinds.h"
#include "engine/observables/observable.h"
#include "engine/scene/smallest_count.h"
#include "engine/start/packing.h"

namespace peclet::engine {
namespace {

// Radii of which there is a sphere; a species without one is refused unless another one has its radius.
std::vector<double> present_radii(const Particles& particles, const std::string& file) {
  const std::vector<std::size_t> number = species_numbers(particles);
  std::vector<double> present;
  for (std::size_t s = 0; s < number.size(); ++s) {
    if (number[s] > 0) present.push_back(particles.species[s].radius);
  }
  present = distinct_radii(present);
  for (std::size_t s = 0; s < number.size(); ++s) {
    const double radius = particles.species[s].radius;
    if (!std::binary_search(present.begin(), present.end(), radius)) {
      const std::size_t enough = smallest_count(particles);
      throw InputError(
          file, "/particles/count", std::to_string(particles.count),
          fmt::format("must be large enough for one sphere of radius {}, whose share is that of {:.2g} "
                      "spheres; {}{}",
                      radius, exact_numbers(particles)[s],
                      enough > 0 ? fmt::format("{} would do for all sizes", enough)
                                 : fmt::format("not even {} would do for all sizes", most_particles),
                      particles.distributed ? ", and `peclet-engine sizes` merges thin ones" : ""));
    }
  }
  return present;
}

}  // namespace

void check_fit(const Scene& scene, const Schedule& schedule, const std::string& file) {
  const std::vector<double> sizes = present_radii(scene.particles, file);
  const Vector3 box = box_lengths(scene, cube_edge(scene.particles, scene.volume_fraction));
  const double nearest = scene.physics.flow.deformation().nearest_image() * std::min({box.x, box.y, box.z});
  const double range = range_table(make_pair_kinds(scene.physics, sizes), sizes.size()).largest();
  if (!(nearest > range)) {
    throw InputError(file, "/particles/count", std::to_string(scene.particles.count),
                     fmt::format("must fill a box larger than the range of the forces, {:.4g}, at this "
                                 "volume fraction (its nearest images would be {:.4g} apart)",
                                 range, nearest));
  }
  make_observables(scene, {schedule.timestep, schedule.production, box}, file);
}

}  // namespace peclet::engine
