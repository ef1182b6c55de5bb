// ActedStress sums the stress of an implicit step with noise, whose forces act at two places
// (kernels/pair_pass.h).
//
// The random forces, and the resistance at the beginning of the step, act at x_n. The forces F(x', V') - A (V
// - V') act at x'. V' are the predicted velocities, V the final ones; A is the matrix of the links by which V
// follows from V'. All forces are moved to x_n + dt V / 2. The change of the stress by the strain of the step
// itself is left out.
//
// Each force counts in the term of its law. The random stress is taken at x_n, where its mean is zero. What
// moving the forces adds is their work against the resistance and counts as lubrication.
#pragma once

#include <vector>

#include "engine/integrators/velocity_solver.h"
#include "engine/state/system.h"
#include "engine/state/threads.h"

namespace peclet::engine {

// Returns the sum of of_particle(i) over all particles: the same bits for any number of threads.
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

// Returns a velocity at the place of particle i, relative to the uniform flow of the cell.
inline Vector3 relative_to_flow(const System& system, std::size_t i, const Vector3& velocity) {
  return velocity - system.box.velocity_gradient() * system.particles.position[i];
}

// Returns the term to which moving the forces to x_n + dt V / 2 adds.
inline StressTerm carried_term(const Physics& physics) {
  if (physics.lubrication) return StressTerm::lubrication;
  if (physics.contact) return StressTerm::contact_normal;
  return physics.repulsion ? StressTerm::repulsion : StressTerm::attraction;
}

class ActedStress {
 public:
  // Takes the sums and forces of the pairs at x_n.
  void begin(const PairSums& sums, const VectorField& force);
  // Adds the sums at x' with the velocities V'. `loads` include the drag at these velocities.
  void predict(const System& system, const PairSums& sums, const Loads& loads, const Physics& physics);
  // Adds the change from V' to V and returns all sums. Requires the particles at x' with the velocities V.
  PairSums end(System& system, ForceField& field, const LinkWeights& weights, double timestep);

  // Do the work of the functions above for each pair. Each is called after its counterpart. They are slow.
  void begin_pairs(const System& system, ForceField& field);
  void predict_pairs(const System& system, ForceField& field);
  void end_pairs(System& system, ForceField& field, const LinkWeights& weights, double timestep);
  void show_pairs(const System& system, PairWatcher& watcher) const;

  // Returns the force of the pairs on a particle at x_n.
  Vector3 force_at_beginning(std::size_t particle) const { return force_at_beginning_[particle]; }

 private:
  struct OfPair {
    PairSums sums;
    Vector3 force_at_beginning, force_ahead;
  };

  PairSums sums_;
  VectorField force_at_beginning_, force_ahead_, force_of_change_, torque_of_change_;
  ForceField::Motion predicted_, change_;
  std::vector<OfPair> pairs_;  // have the order of the list
};

}  // namespace peclet::engine
