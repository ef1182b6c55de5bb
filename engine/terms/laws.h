// This header is the one list of the laws of pairs, of the parts of the stress and of conservative laws.
#pragma once

#include <cstddef>

#include "engine/terms/attraction.h"
#include "engine/terms/repulsion.h"

namespace peclet::engine {

// Terms says which laws a scene needs. Kernels take it as a template argument.
struct Terms {
  bool lubrication = false;
  bool noise = false;     // noise of lubricated pairs; needs lubrication
  bool strained = false;  // lubrication relative to the flow; needs lubrication
  bool contact = false;
  bool damping = false;       // needs contact
  bool friction = false;      // needs contact
  bool rolling = false;       // needs friction
  bool conservative = false;  // any conservative law; each kind of pairs has its own
  bool kinetic = false;       // friction that is less while contacts slide; needs friction

  friend constexpr bool operator==(const Terms&, const Terms&) = default;

  constexpr bool valid() const {
    return (lubrication || !(noise || strained)) && (contact || !(damping || friction)) &&
           (friction || !(rolling || kinetic));
  }
};

// The terms by name, in the order of their bits in the code of a kernel.
struct NamedTerm {
  const char* name;
  bool Terms::*chosen;
};
constexpr NamedTerm every_term[] = {
    {"lubrication", &Terms::lubrication},   {"noise", &Terms::noise},       {"contact", &Terms::contact},
    {"damping", &Terms::damping},           {"friction", &Terms::friction}, {"rolling", &Terms::rolling},
    {"conservative", &Terms::conservative}, {"strained", &Terms::strained}, {"kinetic", &Terms::kinetic},
};
constexpr std::size_t count_of_terms = sizeof(every_term) / sizeof(every_term[0]);

// The parts of the stress that pairs contribute to.
enum class StressTerm : std::size_t {
  lubrication,
  contact_normal,
  contact_damping,
  friction,
  repulsion,
  attraction,
  brownian_lubrication
};

// The names of these parts in every result, and the term that a scene must have for each.
struct StressPart {
  const char* name;
  bool Terms::*of;
};
constexpr StressPart stress_parts[] = {
    {"lubrication", &Terms::lubrication},    {"contact_normal", &Terms::contact},
    {"contact_damping", &Terms::damping},    {"friction", &Terms::friction},
    {"repulsion", &Terms::conservative},     {"attraction", &Terms::conservative},
    {"brownian_lubrication", &Terms::noise},
};
constexpr std::size_t count_of_stress_terms = sizeof(stress_parts) / sizeof(stress_parts[0]);

constexpr const char* name_of(StressTerm term) { return stress_parts[static_cast<std::size_t>(term)].name; }

// EachConservativeLaw has a member for each conservative law.
template <template <class Parameters> class Of>
struct EachConservativeLaw {
  Of<RepulsionParameters> repulsion{};
  Of<AttractionParameters> attraction{};
};

// Calls body(part of the stress, the law's member of each argument) for every conservative law.
template <class Body, class... Each>
PECLET_ALWAYS_INLINE void for_each_conservative_law(Body&& body, Each&&... each) {
  body(StressTerm::repulsion, each.repulsion...);
  body(StressTerm::attraction, each.attraction...);
}

}  // namespace peclet::engine
