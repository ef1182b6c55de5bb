#include "engine/kernels/pairs/terms.h"

#include "engine/scene/scene.h"

namespace peclet::engine {

Terms required_terms(const Physics& physics) {
  Terms terms;
  terms.lubrication = physics.lubrication.has_value();
  terms.noise = terms.lubrication && physics.thermal_energy > 0;
  terms.repulsion = physics.repulsion.has_value();
  if (physics.contact) {
    terms.contact = true;
    terms.damping = physics.contact->normal_damping > 0;
    terms.friction = physics.contact->friction > 0;
    terms.rolling = terms.friction && physics.contact->rolling_stiffness > 0;
  }
  return terms;
}

const char* name_of(StressTerm term) {
  switch (term) {
    case StressTerm::lubrication:
      return "lubrication";
    case StressTerm::contact_normal:
      return "contact_normal";
    case StressTerm::contact_damping:
      return "contact_damping";
    case StressTerm::friction:
      return "friction";
    case StressTerm::repulsion:
      return "repulsion";
    case StressTerm::brownian_lubrication:
      return "brownian_lubrication";
  }
  return "";
}

bool has_stress_term(const Terms& terms, StressTerm term) {
  switch (term) {
    case StressTerm::lubrication:
      return terms.lubrication;
    case StressTerm::contact_normal:
      return terms.contact;
    case StressTerm::contact_damping:
      return terms.damping;
    case StressTerm::friction:
      return terms.friction;
    case StressTerm::repulsion:
      return terms.repulsion;
    case StressTerm::brownian_lubrication:
      return terms.noise;
  }
  return false;
}

}  // namespace peclet::engine
