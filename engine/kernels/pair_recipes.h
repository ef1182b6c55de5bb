// Which laws of pairs a scene has.
#pragma once

#include "engine/terms/laws.h"

namespace peclet::engine {

struct Physics;

// The terms that this physics asks for.
Terms required_terms(const Physics& physics);

// Whether this physics has that part of the stress.
bool has_stress_term(const Physics& physics, StressTerm term);

// Every combination of terms that is compiled, in one place.
//
// Two independent choices (conservative laws; lubrication of either form without or with noise or none) times
// the ways in which spheres can touch make 70 recipes, and 20 more with kinetic friction.
//
// The bits of `code` are the terms in the order of every_term.
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

// What is compiled for these terms: with kinetic friction there always is damping, which may be zero.
constexpr Terms compiled_terms(Terms terms) {
  terms.damping = terms.damping || terms.kinetic;
  return terms;
}

constexpr unsigned count_of_codes = 1U << count_of_terms;

}  // namespace peclet::engine
