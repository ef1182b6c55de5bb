// Measures the variance of the velocities of the spheres over y.
//
// Each bin has the mean of (u - u*)^2 for x, y and z. u* is the mean over the window in slabs of at most a
// fifth of the reference radius, by the centres of the spheres. Velocities are relative to the uniform part
// of the flow.
//
// With n samples in a slab the sum of squares about their own mean is (n - 1) variances. The value of a bin,
//   sum over its slabs of (S2 - S1^2 / n) / sum of (n - 1)
// has the right mean if samples are independent.
#pragma once

#include <cstdint>
#include <vector>

#include "contract/json.h"
#include "engine/state/system.h"

namespace peclet::engine {

class VelocityVariance {
 public:
  VelocityVariance(double height, double reference_radius, std::size_t bins);

  void add(const Vector3& place, const Vector3& velocity);
  // Returns a list of bins for each of x, y and z, with null for bins without a slab of two samples.
  Json value() const;

  void save(ArchiveWriter& archive) const { archive.put_all(samples_, sums_, squares_); }
  void load(ArchiveReader& archive) { archive.get_all(samples_, sums_, squares_); }

 private:
  double height_;
  std::size_t bins_, slabs_of_bin_;
  // Sums in each slab.
  std::vector<double> samples_;
  std::vector<Vector3> sums_, squares_;
};

// Returns the index of bin `k` among `count` periodic bins.
inline std::size_t periodic_bin(std::int64_t k, std::size_t count) {
  const auto bins = static_cast<std::int64_t>(count);
  return static_cast<std::size_t>((k % bins + bins) % bins);
}

}  // namespace peclet::engine
