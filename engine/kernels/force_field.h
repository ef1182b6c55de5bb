// Computes the forces and torques on all particles: those of pairs, drag and noise.
#pragma once

#include <functional>

#include "engine/kernels/link_order.h"
#include "engine/kernels/pair_pass.h"
#include "engine/state/system.h"

namespace peclet::engine {

class ForceField {
 public:
  // `timestep` sets the amplitude of the noise, sqrt(2 kT / dt), and the advance of contact springs. For
  // `approach_time` see PairParameters, for `part` terms/step_resistance.h.
  ForceField(const Physics& physics, const ParticleState& particles, double timestep, std::uint64_t seed,
             int threads, InstructionSet set = chosen_instruction_set(), double approach_time = 0,
             StepResistance::Part part = StepResistance::Part::whole);

  // Overwrites force and torque with those at the system's positions and velocities, with the noise of
  // system.step; contact springs advance by one step of the present motion.
  PairSums evaluate(System& system, VectorField& force, VectorField& torque);

  // Overwrites force and torque with those of pairs alone in system.step, without drag on single spheres and
  // its noise. For terms without friction: springs would advance.
  PairSums evaluate_pairs(System& system, VectorField& force, VectorField& torque);

  // Does the first part of evaluate(): pairs that cross from one block of particles into another act on the
  // particle in the earlier one only after add_incoming(), which works block by block.
  PairSums evaluate_blocks(System& system, VectorField& force, VectorField& torque);
  // Evaluates blocks whose rows `set_drag` sets. On one thread it may also move the block's particles: it is
  // called before any of their pairs is computed.
  using SetDrag = std::function<void(const ParticleBlock& block)>;
  PairSums evaluate_blocks(System& system, VectorField& force, VectorField& torque, const SetDrag& set_drag);
  void add_incoming(const System& system, const ParticleBlock& block, VectorField& force,
                    VectorField& torque) const {
    pair_pass_.add_incoming(system.list, block, force, torque);
  }
  void add_incoming(const System& system, VectorField& force, VectorField& torque) const {
    pair_pass_.add_incoming(system.list, threads_, force, torque);
  }

  // Returns a function that assembles the links of a block's pairs within their range. It is valid until the
  // system changes or the next evaluation. `groups` is made long enough and keeps its storage. Unless `loads`
  // is null, the function also sets there the loads of evaluate_blocks(), up to rounding, and keeps the sums
  // for linked_sums(). This requires leaves_loads_with_links().
  struct LoadRows {
    VectorField &force, &torque;
  };
  using AssembleLinks = std::function<void(std::size_t block)>;
  AssembleLinks assemble_links(System& system, const LinkWeights& weights, LinkOrder& order,
                               std::vector<LinkGroup>& groups, const LoadRows* loads = nullptr);
  // True if assemble_links() can set loads: without friction (evaluations advance springs), damping, noise,
  // lubrication relative to the flow, non-uniform flow and resistance averaged over the way.
  bool leaves_loads_with_links() const;
  // Returns the sums over all blocks whose loads were set with their links.
  PairSums linked_sums() const { return total_of(linked_sums_); }

  // Overwrites force and torque with the loads that a change of the motion `before` adds to pairs, by links
  // of these weights. Returns the stress of these loads.
  struct Motion {
    VectorField velocity, spin;
  };
  PairSums evaluate_change(System& system, const LinkWeights& weights, const Motion& before,
                           const Motion& change, VectorField& force, VectorField& torque);

  // Visit each pair with its loads in the last evaluation, or with those that evaluate_change() adds. Slow.
  void each_pair(const System& system, SpringField springs, const PairPass::VisitPair& visit);
  void each_change(System& system, const LinkWeights& weights, const Motion& before, const Motion& change,
                   const PairPass::VisitPair& visit);

  // Shows each pair of the last evaluation to `watcher`, at these positions and velocities. `springs` are
  // those before that evaluation or, if `advanced`, after it.
  void show_pairs(const System& system, SpringField springs, bool advanced, double weight,
                  PairWatcher& watcher);

  // Returns the input of the loops over particles; `kicks` may be null.
  OneBodyInput one_body_input(System& system, VectorField& force, VectorField& torque,
                              const OneBodyFactors* kicks = nullptr) const;

  // Adds to the rows of particles [begin, end) the drag of the non-uniform flow u', as each sphere feels it
  // (background_flow.h): zeta u' and zeta_r spin'.
  void add_varying_drag(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                        VectorField& torque) const;

  // Adds to a particle's rows the noise of its drag for these standard normals.
  void add_drag_noise(const System& system, std::size_t i, const NormalPair& normals, VectorField& force,
                      VectorField& torque) const {
    const OneBodyFactors& amplitude = drag_noise_[system.particles.size_class[i]];
    force.add(i, amplitude.translational * normals.first);
    torque.add(i, amplitude.rotational * normals.second);
  }

  // Adds to the rows of particles [begin, end) the noise of their drag in system.step.
  void add_drag_noise(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                      VectorField& torque) const;

  // Sets the share of their advance in a step after which springs push; it is 1 by default.
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
  std::vector<PairSums> linked_sums_;              // for each block
  FlowAtCentres varying_;                          // flow at the last evaluation, if pairs feel it
  std::vector<OneBodyFactors> drag_, drag_noise_;  // coefficients and noise amplitudes of each size class
  int threads_;
};

}  // namespace peclet::engine
