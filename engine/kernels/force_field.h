// All forces and torques on all particles: pairs, drag and noise.
#pragma once

#include <functional>

#include "engine/kernels/link_order.h"
#include "engine/kernels/pair_pass.h"
#include "engine/state/system.h"

namespace peclet::engine {

class ForceField {
 public:
  // `timestep` enters the amplitude of the noise, sqrt(2 kT / dt), and the advance of contact springs;
  // `approach_time` see PairParameters, `part` terms/step_resistance.h.
  ForceField(const Physics& physics, const ParticleState& particles, double timestep, std::uint64_t seed,
             int threads, InstructionSet set = chosen_instruction_set(), double approach_time = 0,
             StepResistance::Part part = StepResistance::Part::whole);

  // Overwrites force and torque with those at the system's positions and velocities, with the noise of
  // system.step; contact springs advance by one step of the present motion.
  PairSums evaluate(System& system, VectorField& force, VectorField& torque);

  // Overwrites force and torque with what pairs do in system.step, without the drag of single spheres and its
  // noise. Springs do not advance: of terms without friction.
  PairSums evaluate_pairs(System& system, VectorField& force, VectorField& torque);

  // evaluate() in two parts, the second one block by block: pairs that cross from one block of particles into
  // another act on the particle in the earlier one only after add_incoming().
  PairSums evaluate_blocks(System& system, VectorField& force, VectorField& torque);
  // The same with `set_drag` to set a block's rows, which may also do what is due before: on one thread
  // it is called before any pair of the block's particles is computed.
  using SetDrag = std::function<void(const ParticleBlock& block)>;
  PairSums evaluate_blocks(System& system, VectorField& force, VectorField& torque, const SetDrag& set_drag);
  void add_incoming(const System& system, const ParticleBlock& block, VectorField& force,
                    VectorField& torque) const {
    pair_pass_.add_incoming(system.list, block, force, torque);
  }
  void add_incoming(const System& system, VectorField& force, VectorField& torque) const {
    pair_pass_.add_incoming(system.list, threads_, force, torque);
  }

  // The links of all pairs within their range: what is returned puts those of a block in their places. It
  // holds while the system stands and until the next evaluation. `groups` is made as long as it has to be and
  // keeps its storage. Unless `loads` is null, blocks leave there what evaluate_blocks() would, but for
  // rounding, and their sums for linked_sums(); the field must be able to.
  struct LoadRows {
    VectorField &force, &torque;
  };
  using AssembleLinks = std::function<void(std::size_t block)>;
  AssembleLinks assemble_links(System& system, const LinkWeights& weights, LinkOrder& order,
                               std::vector<LinkGroup>& groups, const LoadRows* loads = nullptr);
  // Not with springs, which an evaluation advances, and what few scenes have.
  bool leaves_loads_with_links() const;
  // The sums of all blocks that have left their loads with their links.
  PairSums linked_sums() const { return total_of(linked_sums_); }

  // Overwrites force and torque with what a change of the motion adds to the loads of pairs, from the motion
  // `before` on and as links of these weights have it; returns the stress of that.
  struct Motion {
    VectorField velocity, spin;
  };
  PairSums evaluate_change(System& system, const LinkWeights& weights, const Motion& before,
                           const Motion& change, VectorField& force, VectorField& torque);

  // Visits each pair as the last evaluation had it, or with what evaluate_change() adds to it. Slow.
  void each_pair(const System& system, SpringField springs, const PairPass::VisitPair& visit);
  void each_change(System& system, const LinkWeights& weights, const Motion& before, const Motion& change,
                   const PairPass::VisitPair& visit);

  // Shows each pair as the last evaluation had it: at these positions and velocities. `springs` are those
  // from before that evaluation, or, `advanced`, those that it has left.
  void show_pairs(const System& system, SpringField springs, bool advanced, double weight,
                  PairWatcher& watcher);

  // What the loops over particles take: the rows of all of them, the flow, and the caller's kicks, if any.
  OneBodyInput one_body_input(System& system, VectorField& force, VectorField& torque,
                              const OneBodyFactors* kicks = nullptr) const;

  // Adds to the rows of particles [begin, end) the drag of what varies within the cell: zeta u' and zeta_r
  // spin', as each sphere feels them.
  void add_varying_drag(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                        VectorField& torque) const;

  // Adds to a particle's rows the noise of its drag that belongs to these standard normals.
  void add_drag_noise(const System& system, std::size_t i, const NormalPair& normals, VectorField& force,
                      VectorField& torque) const {
    const OneBodyFactors& amplitude = drag_noise_[system.particles.size_class[i]];
    force.add(i, amplitude.translational * normals.first);
    torque.add(i, amplitude.rotational * normals.second);
  }

  // Adds to the rows of particles [begin, end) the noise of their drag in system.step.
  void add_drag_noise(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                      VectorField& torque) const;

  // From now on springs push after that share of their advance by a step; before, after all of it.
  void feel_springs_after(double share) { parameters_.felt_share = share; }

  const Terms& terms() const { return terms_; }
  const std::vector<PairKind>& kinds() const { return kinds_; }
  const Physics& physics() const { return physics_; }
  int threads() const { return threads_; }
  const OneBodyKernels& one_body() const { return one_body_; }

 private:
  PairPassInput pair_input(const System& system) const;
  PairKernelInput input_of_change(System& system, const Motion& before);
  void set_varying_flow(const System& system, std::size_t begin, std::size_t end);
  PairSums add_pairs(System& system, VectorField& force, VectorField& torque, const SetDrag& set_rows);

  Physics physics_;
  Terms terms_;
  std::vector<PairKind> kinds_;
  PairPass pair_pass_;
  PairParameters parameters_;
  KeyedRandom pair_noise_, one_body_noise_;
  FillNormals fill_normals_;
  OneBodyKernels one_body_;
  LinkKernels link_;
  std::vector<PairSums> linked_sums_;              // of each block
  FlowAtCentres varying_;                          // of the last evaluation, where pairs feel it
  std::vector<OneBodyFactors> drag_, drag_noise_;  // coefficients of each size class, amplitudes of the noise
  int threads_;
};

}  // namespace peclet::engine
