// Which pairs may interact before the next rebuild: (i, j, image) triples, arranged for the loop over pairs.
//
// A pair is listed when its distance at the time of the build is below
//   reach = range(i, j) + skin (smallest range + (range(i, j) - smallest range) / 10).
// Large pairs need no more room for displacements than small ones; the tenth is room for strain, which moves
// them in proportion to their distance. With d_i the displacement of particle i relative to the affine
// deformation since then, a pair that was left out is at least
//   s reach - |d_i| - |d_j|
// apart, s the smallest singular value of the deformation gradient since the build. The list
// holds as long as that stays above `range` for the two largest displacements and every range; it is
// rebuilt exactly when this can no longer be guaranteed. The same two particles may be listed under several
// images (small boxes), never with themselves.
//
// A list may keep candidates: the pairs within a wider skin, of an earlier moment. As long as these hold
// every pair that is to be listed, narrow() lists the near ones of them anew, a small part of the work of a
// build.
//
// Particles next to each other in memory form blocks of equal size. The pairs of a block are consecutive, and
// among them those of equal kind: a run. A pair of two blocks, a crossing pair, is one of the later block, so
// that whoever walks through the blocks has been at both particles when it meets the pair. Crossing pairs
// have runs of their own; they are numbered, and `incoming` says which of them have a particle in an earlier
// block. The list is a function of the positions at the build, and of those at which the candidates were
// found, alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/state/pair_run.h"
#include "engine/state/particles.h"

namespace peclet::engine {

// Interaction range of each pair of size classes: centre distance beyond which every term is zero.
class RangeTable {
 public:
  RangeTable() = default;
  explicit RangeTable(std::size_t classes) : classes_(classes), range_(classes * classes) {}

  std::size_t classes() const { return classes_; }
  double& at(std::size_t a, std::size_t b) { return range_[a * classes_ + b]; }
  double at(std::size_t a, std::size_t b) const { return range_[a * classes_ + b]; }
  double largest() const { return *std::max_element(range_.begin(), range_.end()); }
  double smallest() const { return *std::min_element(range_.begin(), range_.end()); }

 private:
  std::size_t classes_ = 0;
  std::vector<double> range_;
};

// Where particles were, and the displacement gradient of the cell.
struct ListMoment {
  VectorField position;
  Matrix3 displacement_gradient;
};

// A crossing pair of a later block, and its particle in this one.
struct IncomingPair {
  std::uint32_t particle, crossing;
};

struct ParticleBlock {
  std::uint32_t begin, end;  // particles
  std::uint32_t runs_begin, runs_end;
  std::uint32_t incoming_begin, incoming_end;
};

// State and forces of a block stay in the second-level cache.
constexpr std::size_t most_particles_per_block = 4096;

class NeighbourList {
 public:
  NeighbourList() = default;
  // Candidates are kept where their skin is wider.
  NeighbourList(RangeTable ranges, double skin, double skin_of_candidates = 0)
      : ranges_(std::move(ranges)), skin_(skin), skin_of_candidates_(skin_of_candidates) {}

  // Lists the pairs at the positions as they stand; images are relative to them, wrapped or not.
  // Throws std::invalid_argument when a particle interacts with its own image.
  void build(const ParticleState& particles, const PeriodicCell& box, int threads = 1);

  // Whether the candidates still hold every pair that a build would list.
  bool can_narrow(const ParticleState& particles, const PeriodicCell& box, int threads = 1) const;
  // Lists candidates at the positions as they stand, which must not have been wrapped since the build.
  void narrow(const ParticleState& particles, const PeriodicCell& box, int threads = 1);

  // Rebuilds the list of an earlier moment; `candidates`: the moment of the build. The box may be any of that
  // basis.
  void rebuild_from(ListMoment candidates, ListMoment listed, const ParticleState& particles,
                    PeriodicCell box, int threads = 1);

  // Whether the list still holds every interacting pair.
  bool holds(const ParticleState& particles, const PeriodicCell& box) const;

  // Largest d_i at which holds() is true in this cell, by the criterion above; negative when its deformation
  // alone has used up the skin.
  double allowed_displacement(const PeriodicCell& box) const;
  // The largest |d_i|.
  double largest_displacement(const ParticleState& particles, const PeriodicCell& box, int threads = 1) const;

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<LatticeShift>& images() const { return images_; }  // the first is none
  const std::vector<PairRun>& runs() const { return runs_; }
  const std::vector<ParticleBlock>& blocks() const { return blocks_; }
  const std::vector<IncomingPair>& incoming() const { return incoming_; }
  std::size_t crossings() const { return incoming_.size(); }

  const RangeTable& ranges() const { return ranges_; }
  const ListMoment& listed() const { return listed_; }
  const ListMoment& moment_of_candidates() const { return keeps_candidates() ? found_ : listed_; }
  std::uint64_t builds() const { return builds_; }
  void set_builds(std::uint64_t builds) { builds_ = builds; }

 private:
  friend class ListBuilder;

  bool keeps_candidates() const { return skin_of_candidates_ > skin_; }
  // The distance below which pairs of this range are listed.
  double reach(double range, double skin) const;
  void list_candidates(const ParticleState& particles, const PeriodicCell& box, int threads);
  // Largest displacement since then at which every pair closer than `inner` is closer than `reach` was.
  double allowed_displacement(const ListMoment& then, double skin, double inner_skin,
                              const PeriodicCell& box) const;

  RangeTable ranges_;
  double skin_ = 0, skin_of_candidates_ = 0;
  std::vector<std::vector<FoundPair>> candidates_;  // of each block
  std::vector<Pair> pairs_;
  std::vector<LatticeShift> images_;
  std::vector<PairRun> runs_;
  std::vector<ParticleBlock> blocks_;
  std::vector<IncomingPair> incoming_;
  ListMoment found_, listed_;  // when candidates were found, and pairs listed
  std::uint64_t builds_ = 0;
};

// Blocks of equal size that `particles` fall into: a power of two, so that blocks of particles along the
// space-filling curve are nearly boxes, with the fewest pairs across their faces.
std::size_t count_of_particle_blocks(std::size_t particles);

}  // namespace peclet::engine
