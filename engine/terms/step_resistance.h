// StepResistance gives the resistance R of a pair in an implicit step. xi is the gap x of pair_resistance.h.
//
// Without noise R is averaged over the gaps of the step, from xi_0 to xi_1 (integrators/midpoint.h). The
// squeezing force is then the difference of a potential over the way, whose derivative is X_A(xi_1). It
// changes continuously where pairs enter or leave the range, and Newton's iterations find its zeros.
//
// With noise, where inertia carries a pair across the outer gap (integrators/noisy_midpoint.h), R is split
// into R_o + R_b. R_o is the resistance at the outer gap within the range, and zero beyond: it jumps. R_b is
// continuous. R_o is taken where the step begins and acts on (V_n + V) / 2, so the new velocities feel R_b +
// R_o / 2. R_b is the mean of its average over the gaps from xi_0 to xi_1 and of its value at sqrt(xi_0
// xi_1),
//   xi_1 = xi_0 + w [1 - s + s (1/xi_0 + e) / (1/sqrt(xi_0 xi_w) + e)],  xi_w = xi_0 + w.
// w is the way of the predicted step. Gaps under the roots are at least the inner one, xi_min. To first order
// in w this is R_b in the middle, as in Fixman's step. xi_1 estimates the end of the step: a resistance that
// changes on the way, beside one that does not, leaves a part of w. e = 1 / (4 xi_min), s = 0.65 and the mean
// of two rules are fitted: they keep the density of pairs flat across the inner gap
// (tests/physics/README.md).
#pragma once

#include "engine/terms/lubrication.h"

namespace peclet::engine {

struct StepResistance {
  enum class Part {
    whole,         // R, as it is
    at_beginning,  // R_o / 2 + R_b, with the pairs where the step begins
    ahead,         // R_o / 2 + R_b, with the pairs in the middle of the predicted step, at its velocity
    on_the_way,    // R averaged over the gaps of a step, with the pairs in its middle
    jump,          // R_o / 2, beside noise that belongs to R
    none,          // 0, beside noise that belongs to R
  };
  Part part = Part::whole;
  double timestep = 0;

  // Returns how far beyond the range a pair may be and still have a resistance [length].
  double reach(const LubricatedGap& gap) const {
    return part == Part::ahead || part == Part::on_the_way ? gap.outer_distance : 0;
  }
};

// A gap, the nearest gap between the inner and the outer one, and its L.
template <class Real>
struct BoundedGapOf {
  Real gap, bounded, logarithm;
};

template <class Real>
PECLET_ALWAYS_INLINE BoundedGapOf<Real> bounded_gap(const LubricatedGap& range, const Real& gap) {
  const Real outer{range.outer};
  const Real bounded = select(gap < outer, larger(gap, Real{range.inner}), outer);
  return {gap, bounded, -logarithm(bounded)};
}

template <class Real>
struct WayOf {
  BoundedGapOf<Real> from, to;
  Real per_way;  // 1 / (xi_1 - xi_0)
};

template <class Real>
PECLET_ALWAYS_INLINE WayOf<Real> way_of(const LubricatedGap& range, const Real& begin,
                                        const Real& given_way) {
  const Real shortest{1e-5 * range.inner};  // differences over it keep ten digits
  const Real way = select(larger(given_way, -given_way) < shortest, shortest, given_way);
  return {bounded_gap(range, begin), bounded_gap(range, begin + way), 1.0 / way};
}

// Returns the way of a pair in the middle of a step. `closing` is the velocity dr/dt of the distance.
template <class Real>
PECLET_ALWAYS_INLINE WayOf<Real> way_of_step(const StepResistance& step, const LubricatedGap& range,
                                             const PairGeometryOf<Real>& pair, const Real& closing) {
  const Real way = (range.per_distance * step.timestep) * closing;
  return way_of(range, (range.per_distance * pair.surface_distance() - 0.5 * way) + range.shift, way);
}

// Returns the modes averaged over a way. Beyond the outer gap they are zero, or keep their value there.
enum class Beyond { nothing, as_at_the_gap };
template <Beyond beyond, class Real>
PECLET_ALWAYS_INLINE ResistanceModesOf<Real> mean_modes(const LubricatedGap& range, const WayOf<Real>& way,
                                                        const Real& lever) {
  const double inner = range.inner, outer = range.outer;
  struct Integrals {
    Real inverse, logarithm;
  };
  const auto up_to = [&](const BoundedGapOf<Real>& there) PECLET_INLINE_LAMBDA {
    const Real &L = there.logarithm, below = larger(inner - there.gap, Real{0.0});
    Integrals sum = {-L - (1 / inner) * below, (1.0 + L) * there.bounded - range.inner_logarithm * below};
    if constexpr (beyond == Beyond::as_at_the_gap) {
      const Real out = larger(there.gap - outer, Real{0.0});
      sum.inverse += (1 / outer) * out;
      sum.logarithm += range.outer_logarithm * out;
    }
    return sum;
  };
  const Integrals from = up_to(way.from), to = up_to(way.to);
  return {(to.inverse - from.inverse) * way.per_way, (to.logarithm - from.logarithm) * way.per_way, lever};
}

template <bool shifted = true, class Real>
PECLET_ALWAYS_INLINE ResistanceModesOf<Real> resistance_modes(const StepResistance& step,
                                                              const LubricatedGap& range,
                                                              double lubrication_range,
                                                              const PairGeometryOf<Real>& pair,
                                                              const Real& closing) {
  if (__builtin_expect(step.part == StepResistance::Part::whole, 1)) {
    return resistance_modes<shifted>(range, lubrication_range, pair);
  }
  const double jump = 1 / range.outer, log_jump = range.outer_logarithm;
  const Real inner{range.inner}, zero{0.0}, lever = lever_of<shifted>(range, pair);
  const Real here = gap_of<shifted>(range, pair);
  if (step.part == StepResistance::Part::at_beginning) {
    const auto within = pair.distance <= lubrication_range;
    const Real inverse = 1.0 / larger(here, inner);
    return {select(within, inverse - 0.5 * jump, zero),
            select(within, logarithm(inverse) - 0.5 * log_jump, zero), lever};
  }
  if (step.part == StepResistance::Part::on_the_way) {
    return mean_modes<Beyond::nothing>(range, way_of_step(step, range, pair, closing), lever);
  }
  const Real way = (range.per_distance * step.timestep) * closing, begin = here - 0.5 * way;
  constexpr double changed = 0.65;
  const double around = 0.25 / range.inner;
  const Real from = larger(begin, inner);
  const auto inverse_mean = [&](const Real& made) PECLET_INLINE_LAMBDA {
    return 1.0 / square_root(from * larger(begin + made, inner));
  };
  const Real left = (1.0 / from + around) / (inverse_mean(way) + around);
  const Real made = way * ((1 - changed) + changed * left);
  const ResistanceModesOf<Real> average =
      mean_modes<Beyond::as_at_the_gap>(range, way_of(range, begin, made), lever);
  const Real inverse = larger(inverse_mean(made), Real{jump});
  const auto was_within = begin <= Real{range.outer};
  return {larger(0.5 * (average.inverse + inverse) - jump, zero) + select(was_within, Real{0.5 * jump}, zero),
          larger(0.5 * (average.logarithm + logarithm(inverse)) - log_jump, zero) +
              select(was_within, Real{0.5 * log_jump}, zero),
          lever};
}

// Returns the resistance of pairs to their present motion, beside noise that belongs to `whole`.
template <bool shifted = true, class Real>
PECLET_ALWAYS_INLINE PairResistanceOf<Real> resistance_beside_noise(
    const ResistanceConstants& k, const StepResistance& step, const LubricatedGap& range,
    double lubrication_range, const PairGeometryOf<Real>& pair, const PairResistanceOf<Real>& whole) {
  if (step.part == StepResistance::Part::whole) return whole;
  const bool jumps = step.part == StepResistance::Part::jump;
  const auto within = pair.distance <= lubrication_range;
  const auto half = [&](double outer) PECLET_INLINE_LAMBDA {
    return select(within, Real{jumps ? 0.5 * outer : 0.0}, Real{0.0});
  };
  return pair_resistance(k, ResistanceModesOf<Real>{half(1 / range.outer), half(range.outer_logarithm),
                                                    lever_of<shifted>(range, pair)});
}

// Returns the derivative of the load by the motion. Averaged over the way, the squeezing force at the
// velocity c of the gap is (1/t) times the integral of X_A from xi_0 to xi_0 + t c. Its derivative is X_A at
// xi_1.
template <class Real>
PECLET_ALWAYS_INLINE PairResistanceOf<Real> tangent_resistance(
    const ResistanceConstants& k, const StepResistance& step, const LubricatedGap& range,
    double lubrication_range, const PairGeometryOf<Real>& pair, const Real& closing) {
  if (step.part != StepResistance::Part::on_the_way) {
    return pair_resistance(k, resistance_modes(step, range, lubrication_range, pair, closing));
  }
  const WayOf<Real> way = way_of_step(step, range, pair, closing);
  PairResistanceOf<Real> tangent =
      pair_resistance(k, mean_modes<Beyond::nothing>(range, way, lever_of(range, pair)));
  tangent.squeeze =
      select(way.to.gap <= Real{range.outer},
             k.squeeze_inverse / way.to.bounded + k.squeeze_logarithm * way.to.logarithm, Real{0.0});
  return tangent;
}

}  // namespace peclet::engine
