// Selects the pair terms that a scene needs, and lists the combinations of terms that are compiled.
#pragma once

#include "engine/terms/laws.h"

namespace peclet::engine {

struct Physics;

// Returns the terms that this physics needs.
Terms required_terms(const Physics& physics);

// True if this physics has that part of the stress.
bool has_stress_term(const Physics& physics, StressTerm term);

// Returns the terms of a code, whose bits are the terms in the order of every_term.
//
// Two independent choices (conservative laws or none; no lubrication, or either form of it without or with
// noise) and seven ways in which spheres touch make 70 recipes. Kinetic friction makes 20 more.
constexpr Terms decoded_terms(unsigned code) {
  Terms terms;
  for (unsigned bit = 0; bit < count_of_terms; ++bit) terms.*every_term[bit].chosen = (code >> bit & 1U) != 0;
  return terms;
}

constexpr unsigned code_of(const Terms& terms) {
  unsigned code = 0;
  for (unsigned bit = 0; bit < count_of_terms; ++bit) code |= terms.*every_term[bit].chosen ? 1U << bit : 0U;
  return code;
}

// Returns the terms that are compiled for these: kinetic friction always has damping, which may be zero.
constexpr Terms compiled_terms(Terms terms) {
  terms.damping = terms.damping || terms.kinetic;
  return terms;
}

constexpr unsigned count_of_codes = 1U << count_of_terms;

}  // namespace peclet::engine
