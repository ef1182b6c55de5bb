// AttractionOfPair is the van der Waals attraction of two surfaces.
#pragma once

#include <cmath>

#include "engine/terms/pair.h"

namespace peclet::engine {

struct AttractionParameters {
  double hamaker = 0;            // A_H [energy]
  double regularisation = 0.01;  // eps / a
  double cutoff = 0;             // surface distance where it ends [length]
};

// The law of two radii, as a function of the surface distance h < cutoff (Monti et al. 2021, eq. 7):
//   F_i = V' n = c / (max(h, 0)^2 + eps^2) n,   c = A_H a / 12,  eps = regularisation a,
//   V = c / eps [atan(h / eps) - atan(cutoff / eps)];  in overlap h / eps replaces atan(h / eps)
// with a = 2 a_i a_j / (a_i + a_j). In overlap the force is constant and V'' is zero. Beyond, V'' is
// negative, with the minimum -9 c / (8 sqrt(3) eps^3) at h = eps / sqrt(3).
struct AttractionOfPair {
  double range = 0;  // centre distance where it ends
  double cutoff = 0;
  double scale = 0;  // c
  double width = 0;  // eps

  double energy(double h) const {
    const double inside = h < 0 ? h / width : std::atan(h / width);
    return scale / width * (inside - std::atan(cutoff / width));
  }
  // V'
  template <class Real>
  PECLET_ALWAYS_INLINE Real slope(const Real& h) const {
    const Real gap = larger(h, Real{0.0});
    return scale / (gap * gap + width * width);
  }
  // V''
  template <class Real>
  PECLET_ALWAYS_INLINE Real stiffness(const Real& h) const {
    const Real gap = larger(h, Real{0.0}), squares = gap * gap + width * width;
    return (-2 * scale) * gap / (squares * squares);
  }
  // Returns the largest |V''| at surface distances from h >= 0 on.
  double largest_stiffness(double h) const { return -stiffness(larger(h, width / std::sqrt(3.0))); }
};

inline AttractionOfPair of_pair(const AttractionParameters& attraction, double radius_first,
                                double radius_second) {
  const double sum = radius_first + radius_second, mean = 2 * radius_first * radius_second / sum;
  return {.range = sum + attraction.cutoff,
          .cutoff = attraction.cutoff,
          .scale = attraction.hamaker * mean / 12,
          .width = attraction.regularisation * mean};
}

}  // namespace peclet::engine
