// Frames of a realisation for other programs: centres, motion, stress of each sphere and, where asked for,
// contacts, as a GSD file of the schema "hoomd" 1.4. All numbers are in the units of the scene.
//
// Spheres stand in the order of their ids. A centre is the image in the cell around the origin, -1/2 <=
// fractional < 1/2, velocity is that of this image (the streaming flow there is rate y), and centre + image .
// lattice vectors of the frame is the way that the sphere has gone, also when the basis of the cell changes.
//
// A frame has its first lattice vector along x and its second one in the plane of x and y. The cell of an
// extension or a cross shear does not: places and motion are then those along the rows of log/axes, which are
// unit vectors in the axes of the flow. Stress is in the axes of the flow.
//
// Positions, motion and contacts are those at the end of a step, stress is that of the step: what the means
// of the result add up. log/particles/stress is V sigma_i, xx yy zz xy xz yz, tension positive: half of sym(r
// F_i) of each pair of the sphere, its stresslet as if it were alone and, with noise, -m sym(v v), so that
//   log/stress/total = solvent + (1/V) sum_i V sigma_i.
#pragma once

#include <vector>

#include "engine/gsd/frames.h"
#include "engine/observables/kinds.h"
#include "engine/observables/touching_pairs.h"

namespace peclet::engine {

class Trajectory : public Observable, private PairWatcher {
 public:
  Trajectory(const Scene& scene, const System& system, const Window& window);

  PairWatcher* watcher() override { return this; }
  void sample(const System& system, std::size_t block) override;
  gsd::Frames* frames() override { return &frames_; }

  // The result has nothing of it.
  void add_to(Json& /*mean*/) const override {}
  void add_blocks_to(Json& /*blocks*/) const override {}

  void save(ArchiveWriter& archive) const override { frames_.save(archive); }
  void load(ArchiveReader& archive) override { frames_.load(archive); }

 private:
  void begin(const System& system, double weight) override;
  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override;
  void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) override;

  void add_kinds_of_spheres(const System& system);
  void add_places(const System& system);
  void add_stress(const System& system);
  void add_contacts(const System& system);

  Physics physics_;
  std::vector<PairKind> kinds_;
  bool with_contacts_;
  bool turns_;                          // the cell, against the axes of the flow
  std::vector<std::uint32_t> species_;  // of each id
  std::uint32_t count_of_species_;
  // Of the step that is sampled; shares are those of each id.
  double weight_ = 0;
  PairSums sums_;
  SymmetricTensor motion_;
  std::vector<SymmetricTensor> shares_;
  gsd::Frames frames_;
};

}  // namespace peclet::engine
