// Computes all terms of one pair or of several side by side: the physics of the pair loop, as a pure
// function.
#pragma once

#include "engine/terms/conservative.h"
#include "engine/terms/contact.h"
#include "engine/terms/laws.h"
#include "engine/terms/pair_resistance.h"
#include "engine/terms/spring_laws.h"
#include "engine/terms/step_resistance.h"
#include "engine/terms/strained_lubrication.h"

namespace peclet::engine {

// The constants of all pairs of two radii.
struct PairKind {
  double radius_first, radius_second, sum_of_radii;
  double range;              // centre distance beyond which every term is zero
  double listed_range;       // centre distance up to which forces or observables need the pair
  double lubrication_range;  // centre distance; 0 without lubrication
  double smaller_radius;
  double reduced_diameter;  // 2 a_i a_j / (a_i + a_j)
  LubricatedGap gap;        // set if there is lubrication
  ResistanceConstants resistance;
  RootConstants roots;
  StrainLengths strain;
  ConservativeLaws conservative;
};

// The parameters of all pairs in one evaluation.
struct PairParameters {
  ContactParameters contact;
  double spring_timestep = 0;  // time by which the springs advance; with 0 they stay as they are
  // Forces that depend on the distance are taken at the distance that the present motion leads to in this
  // time; their direction stays.
  double approach_time = 0;
  double felt_share = 1;       // share of the springs' advance after which they push
  double noise_amplitude = 0;  // sqrt(2 kT / dt)
  StepResistance step_resistance = {};
  FlowFrame flow = {};
};

// Returns how far beyond its range a pair of this kind may be and still have a resistance.
inline double kind_reach(const PairParameters& parameters, const PairKind& kind) {
  return parameters.step_resistance.reach(kind.gap);
}

template <class Real>
PECLET_ALWAYS_INLINE ContactOf<Real> contact_of(const ContactParameters& parameters, const PairKind& kind,
                                                const PairGeometryOf<Real>& pair) {
  return {parameters, pair, contact_levers(kind.radius_first, kind.radius_second, pair),
          kind.reduced_diameter};
}

template <class Real>
struct PairNormalsOf {
  Vector3Of<Real> theta, chi;
};

// The loads of each term. Absent terms stay zero and cost nothing: the compiler folds them away.
template <class Real>
struct TermLoadsOf {
  PairLoadOf<Real> lubrication, noise;
  OfEachSpring<PairLoadOf<Real>> springs;
  Vector3Of<Real> contact_normal, contact_damping;
  Vector3Of<Real> conservative;  // sum over all conservative laws
  Real overlap{};                // at which contact forces are taken
};

template <Terms terms, class Real>
PECLET_ALWAYS_INLINE void add_contact_terms(const PairParameters& parameters, const PairKind& kind,
                                            const PairGeometryOf<Real>& pair,
                                            const PairMotionOf<Real>& motion, PairSpringsOf<Real>& springs,
                                            TermLoadsOf<Real>& loads) {
  const ContactParameters& contact = parameters.contact;
  const auto touching = pair.overlap() > 0.0;
  loads.contact_normal = where(touching, contact_normal_force(contact.normal_stiffness, pair));
  if constexpr (terms.damping) {
    loads.contact_damping = where(touching, contact_damping_force(contact.normal_damping, pair, motion));
  }
  const ContactOf<Real> touch = contact_of(contact, kind, pair);
  for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
    using Law = decltype(law);
    Law::of(loads.springs) = advanced_load<Law, terms.kinetic>(touch, motion, parameters.spring_timestep,
                                                               parameters.felt_share, springs);
  });
}

template <class Real>
struct NoVariation {
  PairVariationOf<Real> operator()() const { return {}; }
};

// Returns the loads of pairs that lie within kind.range. `normals()` returns theta and chi; it is called only
// if a pair is lubricated and has noise. `of_law(part, force)` receives the force of each conservative law
// that acts on any of the pairs. `variation()` returns the non-uniform flow at the spheres; it is called only
// if lubrication needs it. The springs advance with the motion and are reset when the contact opens.
template <Terms terms, class Real, class Normals, class OfLaw, class Variation = NoVariation<Real>>
PECLET_ALWAYS_INLINE TermLoadsOf<Real> pair_terms(const PairParameters& parameters, const PairKind& kind,
                                                  const PairGeometryOf<Real>& pair,
                                                  const PairMotionOf<Real>& motion,
                                                  PairSpringsOf<Real>& springs, Normals&& normals,
                                                  OfLaw&& of_law, Variation&& variation = {}) {
  TermLoadsOf<Real> loads;
  PairGeometryOf<Real> ahead = pair;
  if constexpr (terms.contact || terms.conservative) {
    ahead.distance += parameters.approach_time * dot(motion.velocity, pair.normal);
  }
  if constexpr (terms.lubrication) {
    if (any(pair.distance <= kind.lubrication_range + kind_reach(parameters, kind))) {
      // Noise belongs to the whole resistance.
      const ResistanceModesOf<Real> modes = resistance_modes<terms.strained>(
          terms.noise ? StepResistance{} : parameters.step_resistance, kind.gap, kind.lubrication_range, pair,
          dot(motion.velocity, pair.normal));
      const PairResistanceOf<Real> whole = pair_resistance(kind.resistance, modes);
      PairResistanceOf<Real> resistance = whole;
      if constexpr (terms.noise) {
        resistance = resistance_beside_noise<terms.strained>(kind.resistance, parameters.step_resistance,
                                                             kind.gap, kind.lubrication_range, pair, whole);
      }
      if constexpr (terms.strained) {
        loads.lubrication =
            strained_lubrication_load(resistance, parameters.flow, kind.strain, pair, motion,
                                      parameters.flow.varies ? variation() : PairVariationOf<Real>{});
      } else {
        loads.lubrication = lubrication_load(resistance, pair, motion);
      }
      if constexpr (terms.noise) {
        const PairNormalsOf<Real> drawn = normals();
        loads.noise =
            pair_noise_load(parameters.noise_amplitude, resistance_roots(kind.roots, whole.squeeze, modes),
                            pair, drawn.theta, drawn.chi);
      }
    }
  }
  if constexpr (terms.conservative) {
    for_each_conservative_law(
        [&](StressTerm part, const auto& law) PECLET_INLINE_LAMBDA {
          // All pairs of a run agree here. Code of laws after the first is placed out of the way.
          if (part != StressTerm::repulsion) {
            if (__builtin_expect(!(law.range > 0), 1)) return;
          }
          const auto within = ahead.distance < law.range;
          if (!any(within)) [[unlikely]]
            return;
          const Vector3Of<Real> force = where(within, conservative_force(law, ahead));
          loads.conservative += force;
          of_law(part, force);
        },
        kind.conservative);
  }
  if constexpr (terms.contact) {
    loads.overlap = ahead.overlap();
    if (any(ahead.overlap() > 0.0)) {
      add_contact_terms<terms>(parameters, kind, ahead, motion, springs, loads);
    } else if constexpr (terms.friction) {
      springs = {};
    }
  }
  return loads;
}

// Adds the couplings of conservative laws and contacts to `sum`, in the form of a resistance. `pair` has the
// distance at which forces are taken. `held()` returns held_shares() of the springs; it is called only if
// spheres touch and have friction.
template <class Real, class Held>
PECLET_ALWAYS_INLINE void add_stiffness(PairResistanceOf<Real>& sum, const Terms& terms,
                                        const ContactParameters& contact, const PairKind& kind,
                                        const PairGeometryOf<Real>& pair, const CouplingWeights& weights,
                                        Held&& held) {
  if (terms.conservative) sum.squeeze += positive_stiffness(kind.conservative, pair, weights.normal);
  const auto touching = pair.overlap() > 0.0;
  if (!terms.contact || !any(touching)) return;
  sum.squeeze +=
      select(touching, Real{contact_coupling(contact, weights.normal, weights.resistance)}, Real{0.0});
  if (terms.friction) add_springs(sum, terms, contact_of(contact, kind, pair), weights, held());
}

}  // namespace peclet::engine
