// Where other particles are, seen from one.
//
// Every sample counts the separations r = x_j - x_i of all ordered pairs (i, j), each to the nearest image:
// `radial` by |r|, in shells as thick as `bin`; `slice` by (x, y), in squares of that edge, where |z| is
// below `slab`. Beside the counts stand those of points without a structure, N (N - 1) / V times the volume
// of the bin and the number of samples, so that g = counts / ideal, and counts of several realisations may be
// added up. Lengths are in units of the reference radius a. The slice has y >= 0 only: the other half is its
// image in the origin, because every pair is counted from both ends; counts[row][column] has y in the row and
// x in the column.
//
// The nearest image is unique up to half of the box. A fluid at rest may be looked at up to 1 / sqrt(2) of
// it: shells beyond the half are then partly outside of the cube of nearest images, and the ideal count has
// the factor 3 L / (2 r) - 2 of the sphere's surface that is inside. This is how a pair in a small box is
// looked at.
#pragma once

#include <vector>

#include "engine/observables/kinds.h"

namespace peclet::engine {

class PairDistribution : public Observable {
 public:
  // Requires a box in which every pair within the range has one image.
  PairDistribution(const Scene& scene, const System& system, const Window& window);

  void sample(const System& system) override;
  void add_to(Json& mean) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  void count(const Vector3& separation);
  double ideal_shell(std::size_t bin) const;

  double unit_;                // the reference radius
  double range_, bin_, slab_;  // lengths
  double edge_;                // of the box
  double particles_;
  std::size_t bins_;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> radial_;
  std::vector<std::uint64_t> slice_;  // rows of 2 bins_
};

}  // namespace peclet::engine
