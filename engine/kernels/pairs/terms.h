// Which pair terms a scene needs; a compile-time choice of every kernel.
#pragma once

#include <cstddef>

namespace peclet::engine {

struct Physics;

// A structural type: `template <Terms terms>` compiles exactly these.
struct Terms {
  bool lubrication = false;
  bool noise = false;  // of lubricated pairs; needs lubrication
  bool contact = false;
  bool damping = false;   // needs contact
  bool friction = false;  // needs contact
  bool rolling = false;   // needs friction
  bool repulsion = false;

  friend constexpr bool operator==(const Terms&, const Terms&) = default;

  constexpr bool valid() const {
    return (lubrication || !noise) && (contact || !(damping || friction)) && (friction || !rolling);
  }
};

constexpr std::size_t count_of_terms = 7;

// The terms that this physics asks for.
Terms required_terms(const Physics& physics);

// The parts of the stress that pairs contribute to.
enum class StressTerm : std::size_t {
  lubrication,
  contact_normal,
  contact_damping,
  friction,
  repulsion,
  brownian_lubrication
};
constexpr std::size_t count_of_stress_terms = 6;

// "lubrication", "contact_normal", ...: the names in every result.
const char* name_of(StressTerm term);

// Whether a scene with these terms has that part.
bool has_stress_term(const Terms& terms, StressTerm term);

}  // namespace peclet::engine
