// All terms of one pair, each on its own: the physics of the pair loop as a pure function.
#pragma once

#include "engine/kernels/pair_kinds.h"
#include "engine/kernels/terms.h"
#include "engine/random/keyed_random.h"
#include "engine/state/contact_history.h"
#include "engine/terms/contact.h"
#include "engine/terms/friction.h"
#include "engine/terms/lubrication.h"
#include "engine/terms/pair_noise.h"
#include "engine/terms/repulsion.h"
#include "engine/terms/rolling.h"

namespace peclet::engine {

// What is the same for all pairs of one evaluation.
struct PairParameters {
  ContactParameters contact;
  LubricationParameters lubrication;
  double repulsion_strength = 0;
  double spring_timestep = 0;  // by which the springs advance; 0: the springs are taken as they are
  double noise_amplitude = 0;  // sqrt(2 kT / dt)
};

PairParameters pair_parameters(const Physics& physics, double timestep);

// Absent terms stay zero and cost nothing: a sum over a zero constant is folded away by the compiler.
struct TermLoads {
  PairLoad lubrication, noise, friction, rolling;
  Vector3 contact_normal, contact_damping, repulsion;
};

// `noise()` returns the pair's NormalPair (theta, chi) and is only called for a lubricated pair with noise.
// The springs advance with the motion and are forgotten when the contact opens.
template <Terms terms, class Noise>
inline TermLoads pair_terms(const PairParameters& parameters, const PairKind& kind, const PairGeometry& pair,
                            const PairMotion& motion, ContactSprings* springs, Noise&& noise) {
  TermLoads loads;
  if constexpr (terms.lubrication) {
    if (pair.distance <= kind.lubrication_range) {
      const PairResistance resistance =
          pair_resistance(kind.resistance, parameters.lubrication.inner_gap, pair);
      loads.lubrication = lubrication_load(resistance, pair, motion);
      if constexpr (terms.noise) {
        const NormalPair normals = noise();
        loads.noise =
            pair_noise_load(parameters.noise_amplitude, resistance, pair, normals.first, normals.second);
      }
    }
  }
  if constexpr (terms.repulsion) {
    if (pair.distance < kind.repulsion_range) {
      loads.repulsion = repulsion_force(parameters.repulsion_strength, kind.repulsion_length, pair);
    }
  }
  if constexpr (terms.contact) {
    const ContactParameters& contact = parameters.contact;
    if (pair.overlap() > 0) {
      loads.contact_normal = contact_normal_force(contact.normal_stiffness, pair);
      if constexpr (terms.damping) {
        loads.contact_damping = contact_damping_force(contact.normal_damping, pair, motion);
      }
      if constexpr (terms.friction) {
        const double normal_force = contact.normal_stiffness * pair.overlap();
        const ContactLevers lever = contact_levers(kind.radius_first, kind.radius_second, pair);
        springs->tangential = advanced_spring(springs->tangential, pair.normal,
                                              parameters.spring_timestep * slip_velocity(lever, pair, motion),
                                              contact.friction * normal_force / contact.tangential_stiffness);
        loads.friction = friction_load(contact.tangential_stiffness, springs->tangential, lever, pair);
        if constexpr (terms.rolling) {
          springs->rolling = advanced_spring(
              springs->rolling, pair.normal,
              parameters.spring_timestep * rolling_velocity(kind.reduced_diameter, pair, motion),
              contact.rolling_friction * normal_force / contact.rolling_stiffness);
          loads.rolling =
              rolling_load(contact.rolling_stiffness, springs->rolling, kind.reduced_diameter, pair);
        }
      }
    } else if constexpr (terms.friction) {
      *springs = {};
    }
  }
  return loads;
}

}  // namespace peclet::engine
