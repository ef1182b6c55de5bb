// One evaluation of all pair terms: forces and torques on particles, stress by term.
//
// A kernel takes the pairs of one block of particles and adds their loads to that block's rows, in the order
// of the list. What a crossing pair does to its particle in an earlier block is left aside and added
// afterwards, in the order of `incoming`. So no two threads ever write to one place, and the result has the
// same bits for any number of threads.
#pragma once

#include <functional>
#include <vector>

#include "engine/kernels/flow_at_centres.h"
#include "engine/kernels/instruction_set.h"
#include "engine/kernels/pairs/pair_access.h"
#include "engine/random/keyed_random.h"
#include "engine/state/contact_history.h"

namespace peclet::engine {

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
