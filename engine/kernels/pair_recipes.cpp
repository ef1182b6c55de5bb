#include "engine/kernels/pair_recipes.h"

#include "engine/scene/scene.h"

namespace peclet::engine {

Terms required_terms(const Physics& physics) {
  Terms terms;
  terms.lubrication = physics.lubrication.has_value();
  terms.noise = terms.lubrication && physics.thermal_energy > 0;
  terms.strained = terms.lubrication && physics.lubrication->is_relative_to_flow();
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law) {
        terms.conservative = terms.conservative || law.has_value();
      },
      physics);
  if (physics.contact) {
    terms.contact = true;
    terms.damping = physics.contact->normal_damping > 0;
    terms.friction = physics.contact->friction > 0;
    terms.kinetic = terms.friction && remembers_sliding(*physics.contact);
    terms.rolling = terms.friction && physics.contact->rolling_stiffness > 0;
  }
  return terms;
}

bool has_stress_term(const Physics& physics, StressTerm term) {
  bool absent = false;
  for_each_conservative_law(
      [&](StressTerm part, const auto& law) { absent = absent || (part == term && !law.has_value()); },
      physics);
  return !absent && required_terms(physics).*stress_parts[static_cast<std::size_t>(term)].of;
}

}  // namespace peclet::engine
