#include "engine/observables/sphere_stress.h"

#include <algorithm>

#include "engine/observables/structure.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

void SphereStress::clear() {
  pairs_ = {};
  motion_ = {};
  std::ranges::fill(shares_, SymmetricTensor{});
}

std::vector<SymmetricTensor> SphereStress::stresslets(const System& system) const {
  const ParticleState& particles = system.particles;
  const BackgroundFlow flow = physics_.flow.at(system.box);
  const SymmetricTensor uniform = strain_of(system.box.velocity_gradient());
  std::vector<SymmetricTensor> all;
  for (const std::uint32_t i : places_of_ids(particles)) {
    const double a = particles.radius[i];
    all.push_back(
        stresslet_of_sphere(physics_.viscosity, a, uniform + flow.varying_strain(particles.position[i], a)));
  }
  return all;
}

void SphereStress::begin(const System& system, double weight) {
  weight_ = weight;
  shares_.resize(system.particles.count());
}

void SphereStress::take(const System& system, const Pair& pair, const PairSums& sums,
                        const Vector3& /*force*/) {
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) pairs_.stress[t] += weight_ * sums.stress[t];
  const SymmetricTensor half = (0.5 * weight_) * total_stress(sums);
  shares_[system.particles.id[pair.first]] += half;
  shares_[system.particles.id[pair.second]] += half;
}

void SphereStress::take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) {
  motion_ += weight_ * stress;
  shares_[system.particles.id[particle]] += weight_ * stress;
}

}  // namespace peclet::engine
