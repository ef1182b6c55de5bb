// Lists the pairs that may interact before the next rebuild, arranged for the loop over pairs.
//
// A pair is a triple (i, j, image). It is listed if its distance at the build is below
//   reach = range(i, j) + skin (smallest range + (range(i, j) - smallest range) / 10).
// Displacements need the same room for all ranges; the tenth is room for strain, which displaces pairs in
// proportion to their distance. A pair that is not listed stays at least
//   s reach - |d_i| - |d_j|
// apart. Here d_i is the displacement of particle i since the build relative to the affine deformation, and s
// the smallest singular value of the deformation gradient since then. The list holds while this bound, with
// the largest |d| for both particles, exceeds every range. Two particles may be listed under several images
// (in small boxes), a particle never with its own image.
//
// A list may keep candidates: the pairs within a wider skin at an earlier moment. While these contain every
// pair that is to be listed, narrow() selects from them, at a small part of the cost of a build.
//
// Particles next to each other in memory form blocks of equal size. The pairs of a block are consecutive, and
// within it those of one kind: a run. A crossing pair has particles in two blocks and belongs to the later
// one: a loop over the blocks has reached both particles when it meets the pair. Crossing pairs are numbered
// and have runs of their own; `incoming` lists them by their particle in the earlier block. The list depends
// only on positions and cell at the build and at the search for candidates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/state/pair_run.h"
#include "engine/state/particles.h"

namespace peclet::engine {

// The range of each pair of size classes: the centre distance up to which forces or observables need it.
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

// The positions of the particles and the displacement gradient of the cell at one moment.
struct ListMoment {
  VectorField position;
  Matrix3 displacement_gradient;
};

// A crossing pair of a later block and its particle in this block.
struct IncomingPair {
  std::uint32_t particle, crossing;
};

struct ParticleBlock {
  std::uint32_t begin, end;  // particles
  std::uint32_t runs_begin, runs_end;
  std::uint32_t incoming_begin, incoming_end;
};

// State and forces of this many particles fit into the second-level cache.
constexpr std::size_t most_particles_per_block = 4096;

class NeighbourList {
 public:
  NeighbourList() = default;
  // Skins are relative to the smallest range. Candidates are kept if their skin is the wider one.
  NeighbourList(RangeTable ranges, double skin, double skin_of_candidates = 0)
      : ranges_(std::move(ranges)), skin_(skin), skin_of_candidates_(skin_of_candidates) {}

  // Lists the pairs at the present positions; images are relative to these, wrapped or not. Throws
  // std::invalid_argument if a particle interacts with its own image.
  void build(const ParticleState& particles, const PeriodicCell& box, int threads = 1);

  // True if the candidates still contain every pair that a build would list.
  bool can_narrow(const ParticleState& particles, const PeriodicCell& box, int threads = 1) const;
  // Lists candidates at the present positions, which must not have been wrapped since the build.
  void narrow(const ParticleState& particles, const PeriodicCell& box, int threads = 1);

  // Rebuilds a list from its moment_of_candidates() and its listed(). `box` must have the basis of that list;
  // its strain does not matter.
  void rebuild_from(ListMoment candidates, ListMoment listed, const ParticleState& particles,
                    PeriodicCell box, int threads = 1);

  // True if the list still contains every interacting pair.
  bool holds(const ParticleState& particles, const PeriodicCell& box) const;

  // Returns the |d| below which the list holds in this cell; negative if strain alone has used up the skin.
  double allowed_displacement(const PeriodicCell& box) const;
  // Returns the largest |d|.
  double largest_displacement(const ParticleState& particles, const PeriodicCell& box, int threads = 1) const;

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<LatticeShift>& images() const { return images_; }  // the first is zero
  const std::vector<PairRun>& runs() const { return runs_; }
  const std::vector<ParticleBlock>& blocks() const { return blocks_; }
  const std::vector<IncomingPair>& incoming() const { return incoming_; }
  std::size_t crossings() const { return incoming_.size(); }

  const RangeTable& ranges() const { return ranges_; }
  double skin() const { return skin_; }
  double skin_of_candidates() const { return skin_of_candidates_; }
  const ListMoment& listed() const { return listed_; }
  const ListMoment& moment_of_candidates() const { return keeps_candidates() ? found_ : listed_; }
  std::uint64_t builds() const { return builds_; }
  void set_builds(std::uint64_t builds) { builds_ = builds; }

 private:
  friend class ListBuilder;

  bool keeps_candidates() const { return skin_of_candidates_ > skin_; }
  // Returns the distance below which pairs of this range are listed with this skin.
  double reach(double range, double skin) const;
  void list_candidates(const ParticleState& particles, const PeriodicCell& box, int threads);
  // Returns the displacement below which pairs now within reach by `inner_skin` were then within it by
  // `skin`.
  double allowed_displacement(const ListMoment& then, double skin, double inner_skin,
                              const PeriodicCell& box) const;

  RangeTable ranges_;
  double skin_ = 0, skin_of_candidates_ = 0;
  std::vector<std::vector<FoundPair>> candidates_;  // for each block
  std::vector<Pair> pairs_;
  std::vector<LatticeShift> images_;
  std::vector<PairRun> runs_;
  std::vector<ParticleBlock> blocks_;
  std::vector<IncomingPair> incoming_;
  ListMoment found_, listed_;  // when candidates were found and when pairs were listed
  std::uint64_t builds_ = 0;
};

// Returns the number of blocks for this many particles: a power of two, so that blocks along the
// space-filling curve are nearly boxes, with few pairs across their faces.
std::size_t count_of_particle_blocks(std::size_t particles);

}  // namespace peclet::engine
