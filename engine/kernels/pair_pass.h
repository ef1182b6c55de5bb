// Evaluates all pair terms: forces and torques on particles, and the stress by term.
//
// A kernel takes the pairs of one block of particles and adds their loads to that block's rows, in the order
// of the list. Loads of crossing pairs on their particles in earlier blocks are put aside and added
// afterwards, in the order of `incoming`. No two threads write to one place, and the result has the same bits
// for any number of threads.
#pragma once

#include <functional>
#include <vector>

#include "engine/flow/background_flow.h"
#include "engine/kernels/instruction_set.h"
#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_kernels.h"
#include "engine/state/contact_history.h"
#include "engine/state/particles.h"
#include "engine/state/system.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {

// The non-uniform part of the flow at the centres of all particles, for lubrication relative to the flow. It
// has no Faxen corrections, which belong to single spheres.
class FlowAtCentres {
 public:
  FlowAtCentres() = default;
  FlowAtCentres(std::size_t particles, int threads)
      : velocity_(particles, threads),
        spin_(particles, threads),
        strain_along_(particles, threads),
        strain_across_(particles, threads) {}

  std::size_t size() const { return velocity_.size(); }

  // Sets the flow at particles [begin, end), at their present positions.
  void set(const BackgroundFlow& flow, const ParticleState& particles, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [velocity, spin, strain] = flow.varying_at(particles.position[i]);
      velocity_.set(i, velocity);
      spin_.set(i, spin);
      strain_along_.set(i, {strain.xx, strain.yy, strain.zz});
      strain_across_.set(i, {strain.xy, strain.xz, strain.yz});
    }
  }

  FlowRows rows() const {
    return {velocity_.data(), spin_.data(), strain_along_.data(), strain_across_.data()};
  }

 private:
  VectorField velocity_, spin_, strain_along_, strain_across_;
};

// The flux of momentum J through the cell in one step: the stress that acts, times the volume.
//
// A step moves particles from x_n to x_n+1 = x_n + dt V while their velocities change from V_n to V. Pairs
// that exchange the momentum dt F at x change sum m x V by dt sum x F, for any F. Hence
//   dt J = -[sum m x V] of the step + dt sum x F_body = dt [sum over pairs of sym(r F_i) - sum m sym(V V')]
// with x = x_n + dt V / 2 and V' = (V_n + V) / 2 in implicit steps. In velocity Verlet x is that of the
// forces, and V = V' the velocity between the kicks. F is the force that acted, at the velocities of the
// step, with its noise.
struct MomentumFlux {
  SymmetricTensor by_pairs;      // sum over pairs of sym(r F_i), all terms
  SymmetricTensor by_motion;     // from the motion relative to the flow, as steps report it
  SymmetricTensor conservative;  // contact, repulsion, attraction and the motion: even in the velocities
  SymmetricTensor dissipative;   // lubrication and damping: odd

  SymmetricTensor acted() const { return by_pairs + by_motion; }  // J
};

// Returns the stress that results report, times the volume. With noise it includes that of the motion, so
// that the pressure at rest is thermodynamic; without noise it does not.
inline SymmetricTensor stress_of(const MomentumFlux& flux, bool has_noise) {
  return has_noise ? flux.acted() : flux.by_pairs;
}

inline MomentumFlux flux_of(const PairSums& sums, const SymmetricTensor& motion) {
  MomentumFlux flux;
  flux.by_pairs = total_stress(sums);
  flux.by_motion = motion;
  flux.dissipative = sums.of(StressTerm::lubrication) + sums.of(StressTerm::contact_damping);
  flux.conservative = motion + sums.of(StressTerm::contact_normal) + sums.of(StressTerm::repulsion) +
                      sums.of(StressTerm::attraction);
  return flux;
}

// Receives the single pairs of a step.
class PairWatcher {
 public:
  virtual ~PairWatcher() = default;

  // Begins a step, or a part of it with this weight; parts follow each other. `system` has the positions and
  // velocities at which the forces act.
  virtual void begin(const System& system, double weight) = 0;
  // Receives a pair of the system given to begin(): its stress times the volume, and the force on its first
  // sphere, noise included.
  virtual void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) = 0;
  // Takes a particle's part in the stress of the motion, times the volume; called only with noise.
  virtual void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) = 0;
};

// Passes pairs on to several watchers.
class PairWatchers final : public PairWatcher {
 public:
  void clear() { all_.clear(); }
  bool empty() const { return all_.empty(); }
  // Ignores null.
  void add(PairWatcher* watcher) {
    if (watcher != nullptr) all_.push_back(watcher);
  }

  void begin(const System& system, double weight) override {
    for (PairWatcher* const watcher : all_) watcher->begin(system, weight);
  }
  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override {
    for (PairWatcher* const watcher : all_) watcher->take(system, pair, sums, force);
  }
  void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) override {
    for (PairWatcher* const watcher : all_) watcher->take_motion(system, particle, stress);
  }

 private:
  std::vector<PairWatcher*> all_;
};

PairParameters pair_parameters(const Physics& physics, double timestep);

// True if pairs need the non-uniform part of the flow.
bool feels_varying_flow(const Physics& physics);

// Returns the springs that these terms stretch.
SpringKinds spring_kinds(const Terms& terms);

// Returns the sum over blocks, added up in their order.
PairSums total_of(const std::vector<PairSums>& blocks);

// Sets the rows of a block to zero.
void clear_rows(const ParticleBlock& block, VectorField& force, VectorField& torque);

struct PairPassInput {
  const ParticleState& particles;
  const NeighbourList& list;
  const PeriodicCell& box;
  const std::vector<PairKind>& kinds;
  PairParameters parameters;
  NoiseKey noise;                                        // keys the noise of pairs
  const std::vector<NormalPair>* given_noise = nullptr;  // for each pair of the list, instead of `noise`
  const FlowAtCentres* varying = nullptr;                // if lubrication is relative to a non-uniform flow
  int threads = 1;
};

class PairPass {
 public:
  // Throws std::invalid_argument if the terms are not valid or the set is not available.
  PairPass(const Terms& terms, InstructionSet set)
      : PairPass(terms, pair_kernel(set, terms), engine::fill_normals(set)) {}
  PairPass(const Terms& terms, PairKernel kernel, FillNormals fill_normals)
      : kernel_(kernel),
        fill_normals_(fill_normals),
        spring_kinds_(spring_kinds(terms)),
        damps_(terms.damping) {}

  // Sets the rows of force and torque of a block to the loads that do not come from pairs. On one thread it
  // may also move the block's particles: it is called before any of their pairs is computed.
  using SetRows = std::function<void(const ParticleBlock& block)>;

  // Sets the rows of each block by `set_rows`, adds the loads of its pairs while they are in the cache, and
  // returns the sums. Loads on particles of other blocks are left for add_incoming(). `springs`, those of
  // each pair of the list, advance with the motion; without friction they are not touched. Throws
  // std::invalid_argument if the springs are not those of the list or lack kinds that the terms stretch.
  PairSums add_pairs(const PairPassInput& input, SpringField& springs, VectorField& force,
                     VectorField& torque, const SetRows& set_rows);

  // Adds to the rows of a block, or of all blocks, the loads that the last add_pairs() left for them.
  void add_incoming(const NeighbourList& list, const ParticleBlock& block, VectorField& force,
                    VectorField& torque) const;
  void add_incoming(const NeighbourList& list, int threads, VectorField& force, VectorField& torque) const;

  // Returns the input of the loops over pairs, which is valid until the next call or a change of the system.
  PairKernelInput kernel_input(const PairPassInput& input, SpringField& springs);

  // Returns room for the loads on particles of other blocks, which add_incoming() adds.
  double* crossing_rows(const NeighbourList& list);

  // Computes each pair alone and calls `visit` with it, its part of the sums and the force on its first
  // sphere. Loads are dropped; `springs` advance as in add_pairs(). Slow.
  using VisitPair = std::function<void(const Pair& pair, const PairSums& sums, const Vector3& force)>;
  void each_pair(const PairPassInput& input, SpringField& springs, const VisitPair& visit);
  // Calls `compute` with each pair alone, as a run of length 1, with sums and force at zero; then calls
  // `visit` with the pair and with what `compute` wrote. Slow.
  using ComputePair = std::function<void(const PairRun& pair, const PairKernelOutput& out)>;
  static void each_pair(const NeighbourList& list, const ComputePair& compute, const VisitPair& visit);

  // Sets force and torque to the sums over pairs.
  PairSums evaluate(const PairPassInput& input, SpringField& springs, VectorField& force,
                    VectorField& torque);

 private:
  PairKernel kernel_;
  FillNormals fill_normals_;
  SpringKinds spring_kinds_;
  bool damps_;  // false if only the compiled kernel has damping: compiled_terms()
  // Storage that is kept from step to step.
  VectorField image_displacement_, image_velocity_;
  std::vector<std::uint64_t> image_keys_;
  VectorField crossing_;        // force and torque on the particle of each crossing pair in the other block
  std::vector<PairSums> sums_;  // two of each block
};

}  // namespace peclet::engine
