// All forces and torques on all particles: pairs, drag and noise.
#pragma once

#include "engine/kernels/pair_pass.h"
#include "engine/state/system.h"

namespace peclet::engine {

class ForceField {
 public:
  // `timestep` enters the amplitude of the noise, sqrt(2 kT / dt), and the advance of contact springs.
  ForceField(const Physics& physics, const ParticleState& particles, double timestep, std::uint64_t seed,
             int threads, InstructionSet set = chosen_instruction_set());

  // Overwrites force and torque with those at the system's positions and velocities, with the noise of
  // system.step; contact springs advance by one step of the present motion.
  PairSums evaluate(System& system, VectorField& force, VectorField& torque);

  const Terms& terms() const { return terms_; }
  const std::vector<PairKind>& kinds() const { return kinds_; }
  const Physics& physics() const { return physics_; }
  int threads() const { return threads_; }

 private:
  void add_drag(const ParticleState& particles, std::size_t begin, std::size_t end, VectorField& force,
                VectorField& torque) const;
  void add_drag_noise(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                      VectorField& torque) const;

  Physics physics_;
  Terms terms_;
  std::vector<PairKind> kinds_;
  PairPass pair_pass_;
  PairParameters parameters_;
  KeyedRandom pair_noise_, one_body_noise_;
  FillNormals fill_normals_;
  // Of each size class: coefficients of drag, and the amplitudes of its noise.
  struct DragOfClass {
    double translational, rotational, force_noise, torque_noise;
  };
  std::vector<DragOfClass> drag_;
  int threads_;
};

}  // namespace peclet::engine
