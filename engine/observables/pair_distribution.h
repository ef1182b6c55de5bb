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

#include <array>
#include <vector>

#include "engine/averages/blocked_mean.h"
#include "engine/observables/kinds.h"

namespace peclet::engine {

class PairDistribution : public Observable {
 public:
  // Requires a box in which every pair within the range has one image.
  PairDistribution(const Scene& scene, const System& system, const Window& window);

  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json& blocks) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  void count(const Vector3& separation, std::size_t quarter);
  double ideal_shell(std::size_t bin) const;
  // Ordered pairs in a unit of volume, of so many samples without a structure.
  double ideal_pairs(std::uint64_t samples) const;

  double unit_;                // the reference radius
  double range_, bin_, slab_;  // lengths
  double edge_, volume_;       // the shortest edge of the box
  double particles_;
  std::size_t bins_;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> radial_;
  // Of the quarters of the window; without rows where there are too many bins.
  std::array<std::uint64_t, count_of_quarters> quarter_samples_{};
  std::vector<std::uint64_t> radial_quarters_;  // rows of bins_
  std::vector<std::uint64_t> slice_;            // rows of 2 bins_
};

}  // namespace peclet::engine
