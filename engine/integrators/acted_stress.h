// The stress that acts in a step (kernels/pair_pass.h), of forces that act at several places.
//
// With noise an implicit step acts upon its pairs at two places: with the random forces, and what else
// belongs to the beginning, at x_n; and with F(x', V') - A (V - V') at x', where the velocities V' have been
// predicted and A, the matrix of the links, has turned them into V. Both are brought to x_n + dt V / 2. What
// a step's strain makes of its own stress is left out.
//
// By term: each force belongs to its law. The random stress is that of x_n, where its mean is zero; what
// bringing forces along adds belongs to the resistance that they work against, lubrication.
#pragma once

#include <vector>

#include "engine/integrators/velocity_solver.h"
#include "engine/state/system.h"
#include "engine/state/threads.h"

namespace peclet::engine {

// Returns the sum of of_particle(i) over all particles, with the same bits for any number of threads.
template <class OfParticle>
SymmetricTensor sum_over_particles(const System& system, int threads, OfParticle&& of_particle) {
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  std::vector<SymmetricTensor> sums(blocks.size());
  for_each_index(blocks.size(), threads, [&](std::size_t b) {
    for (std::size_t i = blocks[b].begin; i < blocks[b].end; ++i) sums[b] += of_particle(i);
  });
  SymmetricTensor total;
  for (const SymmetricTensor& sum : sums) total += sum;
  return total;
}

// A velocity at the place of a particle, relative to the uniform flow of the cell.
inline Vector3 relative_to_flow(const System& system, std::size_t i, const Vector3& velocity) {
  return velocity - system.box.velocity_gradient() * system.particles.position[i];
}

class ActedStress {
 public:
  // `sums` and `force` are those of the pairs at x_n.
  void begin(const PairSums& sums, const VectorField& force);
  // At x' with the velocities V'; `loads` have the drag on these.
  void predict(const System& system, const PairSums& sums, const Loads& loads, const Physics& physics);
  // Once the velocities are found and before the particles move on from x'.
  PairSums end(System& system, ForceField& field, const LinkWeights& weights, double timestep);

  // The stress of each pair, after the functions above: slow, for what is looked at seldom.
  void begin_pairs(const System& system, ForceField& field);
  void predict_pairs(const System& system, ForceField& field);
  void end_pairs(System& system, ForceField& field, const LinkWeights& weights, double timestep);
  void show_pairs(const System& system, PairWatcher& watcher) const;

  // Force of the pairs on a particle at x_n.
  Vector3 force_at_beginning(std::size_t particle) const { return force_at_beginning_[particle]; }

 private:
  struct OfPair {
    PairSums sums;
    Vector3 force_at_beginning, force_ahead;
  };

  PairSums sums_;
  VectorField force_at_beginning_, force_ahead_, force_of_change_, torque_of_change_;
  ForceField::Motion predicted_, change_;
  std::vector<OfPair> pairs_;  // of the list
};

}  // namespace peclet::engine
