// Which pairs may interact before the next rebuild: (i, j, image) triples with i < j.
//
// A pair is listed when its distance at the time of the build is below range(i, j) + skin. With d_i the
// displacement of particle i relative to the affine deformation since then, a pair that was left out is at
// least
//   s (range + skin) - |d_i| - |d_j|
// apart, s the smallest singular value of the deformation gradient of the strain since the build. The list
// holds as long as that stays above `range` for the two largest displacements; it is rebuilt exactly when
// this can no longer be guaranteed. The same two particles may be listed under several images (small boxes),
// never with themselves. Pairs are sorted by (i, j, image): the list is a function of the positions at the
// build alone.
#pragma once

#include <cstdint>
#include <vector>

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
  double largest() const;

 private:
  std::size_t classes_ = 0;
  std::vector<double> range_;
};

struct Pair {
  std::uint32_t first, second;  // first < second
  std::uint16_t image;          // index into NeighbourList::images(): the shift of `second`
  std::uint16_t kind;           // size_class(first) * classes + size_class(second)
};

class NeighbourList {
 public:
  NeighbourList() = default;
  NeighbourList(RangeTable ranges, double skin) : ranges_(std::move(ranges)), skin_(skin) {}

  // Lists the pairs at the positions as they stand; images are relative to them, wrapped or not.
  // Throws std::invalid_argument when a particle interacts with its own image.
  void build(const ParticleState& particles, const ShearedBox& box);

  // Rebuilds the list of an earlier moment: the reference positions and the box as they were at the build.
  void rebuild_from(VectorField reference, const ParticleState& particles, const ShearedBox& box_then);

  // Whether the list still holds every interacting pair.
  bool holds(const ParticleState& particles, const ShearedBox& box) const;

  // Largest d_i at which holds() is true at this strain, by the criterion above; negative when the strain
  // alone has used up the skin.
  double allowed_displacement(const ShearedBox& box) const;
  // The largest |d_i|.
  double largest_displacement(const ParticleState& particles, const ShearedBox& box) const;

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<LatticeShift>& images() const { return images_; }
  const RangeTable& ranges() const { return ranges_; }
  const VectorField& reference() const { return reference_; }
  double strain_at_build() const { return strain_at_build_; }
  std::uint64_t builds() const { return builds_; }
  void set_builds(std::uint64_t builds) { builds_ = builds; }

  // The pairs of one particle in the order of the list; an entry is 2 * pair + (1 if the particle is its
  // second).
  struct Incidence {
    const std::uint32_t *begin_, *end_;
    const std::uint32_t* begin() const { return begin_; }
    const std::uint32_t* end() const { return end_; }
  };
  Incidence incident(std::size_t particle) const {
    return {incident_.data() + first_incident_[particle], incident_.data() + first_incident_[particle + 1]};
  }

 private:
  void collect_incidence(std::size_t particles);

  RangeTable ranges_;
  double skin_ = 0;
  std::vector<Pair> pairs_;
  std::vector<LatticeShift> images_;
  std::vector<std::uint32_t> first_incident_, incident_;
  VectorField reference_;
  double strain_at_build_ = 0;
  std::uint64_t builds_ = 0;
};

}  // namespace peclet::engine
