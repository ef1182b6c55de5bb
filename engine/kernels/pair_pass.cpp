#include "engine/kernels/pair_pass.h"

#include <algorithm>

#include "engine/kernels/for_each_range.h"
#include "engine/kernels/pair_loop.h"
#include "engine/kernels/recipes.h"

namespace peclet::engine {

PairParameters pair_parameters(const Physics& physics, double timestep) {
  PairParameters parameters;
  parameters.contact = physics.contact.value_or(ContactParameters{});
  parameters.lubrication = physics.lubrication.value_or(LubricationParameters{});
  parameters.repulsion_strength = physics.repulsion ? physics.repulsion->strength : 0;
  parameters.spring_timestep = timestep;
  parameters.noise_amplitude = timestep > 0 ? std::sqrt(2 * physics.thermal_energy / timestep) : 0;
  return parameters;
}

PairSums& PairSums::operator+=(const PairSums& other) {
  for (std::size_t t = 0; t < stress.size(); ++t) {
    stress[t] += other.stress[t];
  }
  contacts += other.contacts;
  largest_overlap = std::max(largest_overlap, other.largest_overlap);
  finite = finite && other.finite;
  return *this;
}

void gather_loads(const NeighbourList& list, const std::vector<PairLoad>& loads, int threads,
                  VectorField& force, VectorField& torque) {
  for_each_range(force.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vector3 f, t;
      for (const std::uint32_t entry : list.incident(i)) {
        const PairLoad& load = loads[entry >> 1];
        if ((entry & 1) == 0) {
          f += load.force;
          t += load.torque_first;
        } else {
          f -= load.force;
          t += load.torque_second;
        }
      }
      force.set(i, f);
      torque.set(i, t);
    }
  });
}

PairPass pair_pass(const Terms& terms) {
  return with_recipe(terms, []<Terms recipe>() -> PairPass { return &run_pair_pass<recipe>; });
}

}  // namespace peclet::engine
