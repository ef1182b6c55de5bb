// The resistance of a pair as an implicit step with noise counts it, where inertia carries a pair across the
// outer gap (integrators/noisy_midpoint.h).
//
// With R_o the resistance at the outer gap, within the range, and zero beyond, R = R_o + R_b: R_b is
// continuous, R_o jumps. R_o is that of the gap at which the step begins and acts on (V_n + V) / 2; so the
// new velocities feel R_b + R_o / 2. R_b is the mean of its average over the gaps from xi_0 to xi_1 and of
// its value at sqrt(xi_0 xi_1),
//   xi_1 = xi_0 + w [1 - s + s (1/xi_0 + e) / (1/sqrt(xi_0 xi_w) + e)],  xi_w = xi_0 + w,
// with the way w of the predicted step and no gap below the inner one xi_min under the roots: to first order
// in w it is R_b in the middle, as in Fixman's step. xi_1 is where the step ends with what a resistance
// that changes on the way, beside another one that does not, leaves of w. e = 1 / (4 xi_min), s = 0.65 and
// the mean of two rules are fitted: they keep the density of pairs flat across the inner gap
// (tests/physics/README.md).
//
// The stress has R averaged over the way that is made: then the squeezing part of a pair's r F is the change
// of a function of the gap, whose mean is zero in equilibrium at any step.
#pragma once

#include "engine/terms/lubrication.h"

namespace peclet::engine {

struct StepResistance {
  enum class Part {
    whole,         // R, as it is
    at_beginning,  // R_o / 2 + R_b; the pairs stand where the step begins
    ahead,         // the same; the pairs stand in the middle of the predicted step and move with its velocity
    on_the_way,    // R, averaged over the gaps of a step in whose middle the pairs stand
  };
  Part part = Part::whole;
  double timestep = 0;

  // How much farther than its range a pair may stand and still have a resistance.
  double reach(const LubricationParameters& lubrication, double sum_of_radii) const {
    return part == Part::ahead || part == Part::on_the_way ? 0.5 * lubrication.outer_gap * sum_of_radii : 0;
  }
};

// Averages over the gaps from `begin` to `begin` + `way`; beyond the outer gap there is that share of what
// is there.
template <class Real>
PECLET_ALWAYS_INLINE ResistanceModesOf<Real> mean_modes(const LubricationParameters& lubrication,
                                                        double share_beyond, const Real& begin,
                                                        const Real& given_way, const Real& lever) {
  const Real shortest{1e-5 * lubrication.inner_gap};  // of which differences keep ten digits
  const Real way = select(larger(given_way, -given_way) < shortest, shortest, given_way);
  const double inner = lubrication.inner_gap;
  struct Integrals {
    Real inverse, logarithm;
  };
  const auto up_to = [&](const Real& gap) PECLET_INLINE_LAMBDA {
    const Real inverse = larger(1.0 / larger(gap, Real{inner}), Real{1 / lubrication.outer_gap});
    const Real L = logarithm(inverse), below = larger(inner - gap, Real{0.0});
    const Real beyond = share_beyond * larger(gap - lubrication.outer_gap, Real{0.0});
    return Integrals{
        (1 / lubrication.outer_gap) * beyond - L - (1 / inner) * below,
        std::log(1 / lubrication.outer_gap) * beyond + (1.0 + L) / inverse - std::log(1 / inner) * below};
  };
  const Integrals from = up_to(begin), to = up_to(begin + way);
  const Real per_way = 1.0 / way;
  return {(to.inverse - from.inverse) * per_way, (to.logarithm - from.logarithm) * per_way, lever};
}

template <class Real>
PECLET_ALWAYS_INLINE ResistanceModesOf<Real> resistance_modes(const StepResistance& step,
                                                              const LubricationParameters& lubrication,
                                                              double range, const PairGeometryOf<Real>& pair,
                                                              const Real& closing) {
  if (__builtin_expect(step.part == StepResistance::Part::whole, 1)) {
    return resistance_modes(lubrication.inner_gap, range, pair);
  }
  const double jump = 1 / lubrication.outer_gap, log_jump = std::log(jump);
  const double per_radius = 2 / pair.sum_of_radii;
  const Real inner{lubrication.inner_gap}, zero{0.0}, lever = (1 / pair.sum_of_radii) * pair.distance;
  const Real here = per_radius * pair.surface_distance();
  if (step.part == StepResistance::Part::at_beginning) {
    const auto within = pair.distance <= range;
    const Real inverse = 1.0 / larger(here, inner);
    return {select(within, inverse - 0.5 * jump, zero),
            select(within, logarithm(inverse) - 0.5 * log_jump, zero), lever};
  }
  const Real way = (per_radius * step.timestep) * closing, begin = here - 0.5 * way;
  if (step.part == StepResistance::Part::on_the_way) {
    return mean_modes(lubrication, /*share_beyond=*/0, begin, way, lever);
  }
  constexpr double changed = 0.65;
  const double around = 0.25 / lubrication.inner_gap;
  const Real from = larger(begin, inner);
  const auto inverse_mean = [&](const Real& made) PECLET_INLINE_LAMBDA {
    return 1.0 / square_root(from * larger(begin + made, inner));
  };
  const Real left = (1.0 / from + around) / (inverse_mean(way) + around);
  const Real made = way * ((1 - changed) + changed * left);
  const ResistanceModesOf<Real> average = mean_modes(lubrication, /*share_beyond=*/1, begin, made, lever);
  const Real inverse = larger(inverse_mean(made), Real{jump});
  const auto was_within = begin <= Real{lubrication.outer_gap};
  return {larger(0.5 * (average.inverse + inverse) - jump, zero) + select(was_within, Real{0.5 * jump}, zero),
          larger(0.5 * (average.logarithm + logarithm(inverse)) - log_jump, zero) +
              select(was_within, Real{0.5 * log_jump}, zero),
          lever};
}

}  // namespace peclet::engine
