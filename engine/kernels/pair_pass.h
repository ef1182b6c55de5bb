// One evaluation of all pair terms: forces and torques on particles, stress by term.
//
// A kernel takes the pairs of one block of particles and adds their loads to that block's rows, in the order
// of the list. What a crossing pair does to its particle in an earlier block is left aside and added
// afterwards, in the order of `incoming`. So no two threads ever write to one place, and the result has the
// same bits for any number of threads.
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

// What varies of the flow within the cell, at the centres of all particles, for lubrication that is relative
// to the flow: without Faxen's corrections, which belong to single spheres.
class FlowAtCentres {
 public:
  FlowAtCentres() = default;
  FlowAtCentres(std::size_t particles, int threads)
      : velocity_(particles, threads),
        spin_(particles, threads),
        strain_along_(particles, threads),
        strain_across_(particles, threads) {}

  std::size_t size() const { return velocity_.size(); }

  // Of particles [begin, end) where they are now.
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

// What carries momentum through the cell in one step, times the volume: the stress that acts.
//
// A step moves particles from x_n to x_n+1 = x_n + dt V at velocities that change from V_n to V. Pairs that
// exchange the momentum dt F at x change sum m x V by dt sum x F, whatever F is made of, so that
//   dt J = -[sum m x V] of the step + dt sum x F_body = dt [sum over pairs of sym(r F_i) - sum m sym(V V')]
// with x = x_n + dt V / 2 and V' = (V_n + V) / 2 in implicit steps; in velocity Verlet x is that of the
// forces and V = V' the velocity in between. F is the force that acted: of the velocities that the step has
// found, with its noise.
struct MomentumFlux {
  SymmetricTensor by_pairs;      // sum over pairs of sym(r F_i), all terms
  SymmetricTensor by_motion;     // of the motion relative to the flow, as steps report it
  SymmetricTensor conservative;  // contact, repulsion, attraction and the motion: even in the velocities
  SymmetricTensor dissipative;   // lubrication and damping: odd

  SymmetricTensor acted() const { return by_pairs + by_motion; }  // J
};

// The stress that results report, times the volume: with noise that of the motion is a part of it, by which
// the pressure at rest is the one of thermodynamics; without noise it is left out.
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

// Who looks at the single pairs of a step.
class PairWatcher {
 public:
  virtual ~PairWatcher() = default;

  // Of a step, or of a part of it with this weight, whose parts follow each other: where the spheres are and
  // how fast when their forces act.
  virtual void begin(const System& system, double weight) = 0;
  // One of its pairs: its part of the stress, times the volume, and the force on its first sphere, noise
  // included. Of the system of begin().
  virtual void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) = 0;
  // With noise, the part of a particle in the stress of the motion, times the volume.
  virtual void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) = 0;
};

// Several of them, as one.
class PairWatchers final : public PairWatcher {
 public:
  void clear() { all_.clear(); }
  bool empty() const { return all_.empty(); }
  // Nothing of null.
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

// Whether pairs are to be given what varies of the flow.
bool feels_varying_flow(const Physics& physics);

// The springs that these terms stretch.
SpringKinds spring_kinds(const Terms& terms);

// The sums of blocks, added up in their order.
PairSums total_of(const std::vector<PairSums>& blocks);

// Sets the rows of a block to zero.
void clear_rows(const ParticleBlock& block, VectorField& force, VectorField& torque);

struct PairPassInput {
  const ParticleState& particles;
  const NeighbourList& list;
  const PeriodicCell& box;
  const std::vector<PairKind>& kinds;
  PairParameters parameters;
  NoiseKey noise;                                        // of pairs
  const std::vector<NormalPair>* given_noise = nullptr;  // of each pair of the list, instead
  const FlowAtCentres* varying = nullptr;                // what varies, where lubrication is relative to it
  int threads = 1;
};

class PairPass {
 public:
  // Throws std::invalid_argument for terms that are not valid and for a set that is not available.
  PairPass(const Terms& terms, InstructionSet set)
      : PairPass(terms, pair_kernel(set, terms), engine::fill_normals(set)) {}
  PairPass(const Terms& terms, PairKernel kernel, FillNormals fill_normals)
      : kernel_(kernel),
        fill_normals_(fill_normals),
        spring_kinds_(spring_kinds(terms)),
        damps_(terms.damping) {}

  // Sets the rows of force and torque of a block to what does not come from pairs. On one thread, what is
  // done here to a block's particles is done before any of their pairs is computed.
  using SetRows = std::function<void(const ParticleBlock& block)>;

  // Has the rows of each block set, adds the loads of its pairs while they are in the cache, and returns the
  // sums of the stress. What crosses into other blocks is left for add_incoming().
  // `springs` are those of each pair of the list; they advance with the motion. Without friction they are not
  // touched. Throws std::invalid_argument when the springs are not those of the list, or not of the kinds
  // that the terms stretch.
  PairSums add_pairs(const PairPassInput& input, SpringField& springs, VectorField& force,
                     VectorField& torque, const SetRows& set_rows);

  // Adds to the rows of a block, or of all of them, what the last add_pairs() left for it.
  void add_incoming(const NeighbourList& list, const ParticleBlock& block, VectorField& force,
                    VectorField& torque) const;
  void add_incoming(const NeighbourList& list, int threads, VectorField& force, VectorField& torque) const;

  // What the loops over pairs take; valid until the next call, and while the system stands.
  PairKernelInput kernel_input(const PairPassInput& input, SpringField& springs);

  // Room for what crosses into other blocks, which add_incoming() adds.
  double* crossing_rows(const NeighbourList& list);

  // Computes each pair alone and calls `visit` with it, its part of the sums and the force on its first
  // sphere. Loads go nowhere; `springs` advance as in add_pairs(). Slow: for what is looked at seldom.
  using VisitPair = std::function<void(const Pair& pair, const PairSums& sums, const Vector3& force)>;
  void each_pair(const PairPassInput& input, SpringField& springs, const VisitPair& visit);
  // Calls `compute` with each pair alone, as a run of length 1, and with rows and sums that are zero; then
  // calls `visit` with the pair and what `compute` wrote there. Slow, too.
  using ComputePair = std::function<void(const PairRun& pair, const PairKernelOutput& out)>;
  static void each_pair(const NeighbourList& list, const ComputePair& compute, const VisitPair& visit);

  // Sets force and torque to the sums over pairs.
  PairSums evaluate(const PairPassInput& input, SpringField& springs, VectorField& force,
                    VectorField& torque);

 private:
  PairKernel kernel_;
  FillNormals fill_normals_;
  SpringKinds spring_kinds_;
  bool damps_;  // the kernel may do so where the terms do not: compiled_terms()
  // Storage that is kept from step to step.
  VectorField image_displacement_, image_velocity_;
  std::vector<std::uint64_t> image_keys_;
  VectorField crossing_;        // force and torque on the away particle of each crossing pair
  std::vector<PairSums> sums_;  // two of each block
};

}  // namespace peclet::engine
