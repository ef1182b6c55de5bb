// The loads of a pair by all its terms, and comparisons of loads.
#pragma once

#include "engine/kernels/pair_pass.h"
#include "tests/engine/two_spheres.h"

namespace peclet::engine {

// Returns the loads of a pair without noise; its springs advance by a step.
template <Terms terms>
TermLoadsOf<double> loads_of_terms(const PairParameters& parameters, const PairKind& kind,
                                   const PairGeometry& pair, const PairMotion& motion,
                                   PairSpringsOf<double>& springs) {
  return pair_terms<terms>(
      parameters, kind, pair, motion, springs, [] { return PairNormalsOf<double>{}; },
      [](StressTerm /*part*/, const Vector3& /*force*/) {});
}

inline double size_of_load(const PairLoad& load) {
  return norm(load.force) + norm(load.torque_first) + norm(load.torque_second);
}

inline double difference(const PairLoad& a, const PairLoad& b) {
  return size_of_load(
      {a.force - b.force, a.torque_first - b.torque_first, a.torque_second - b.torque_second});
}

// Returns the motion as seen from the other sphere: the normal and the relative velocity change sign.
inline PairMotion from_the_other(const PairMotion& motion) {
  return {-motion.velocity, motion.spin_second, motion.spin_first};
}

// Expects opposite forces and exchanged torques of a pair that is seen from both spheres.
inline void expect_opposite(const PairLoad& here, const PairLoad& there, double tolerance) {
  const PairLoad expected = {-there.force, there.torque_second, there.torque_first};
  for (const auto part : {&PairLoad::force, &PairLoad::torque_first, &PairLoad::torque_second}) {
    EXPECT_LT(norm(here.*part - expected.*part), tolerance * size_of_load(here));
  }
}

}  // namespace peclet::engine
