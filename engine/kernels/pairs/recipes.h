// Every combination of terms that is compiled, in one place.
//
// Two independent choices (repulsion; lubrication without or with noise or none) times the ways in which
// spheres can touch make 42 recipes.
#pragma once

#include "engine/kernels/pairs/terms.h"

namespace peclet::engine {

// The bits of `code` are the terms in the order of the struct.
constexpr Terms decoded_terms(unsigned code) {
  return {.lubrication = (code & 1) != 0,
          .noise = (code & 2) != 0,
          .contact = (code & 4) != 0,
          .damping = (code & 8) != 0,
          .friction = (code & 16) != 0,
          .rolling = (code & 32) != 0,
          .repulsion = (code & 64) != 0};
}

constexpr unsigned code_of(const Terms& terms) {
  return (terms.lubrication ? 1U : 0U) | (terms.noise ? 2U : 0U) | (terms.contact ? 4U : 0U) |
         (terms.damping ? 8U : 0U) | (terms.friction ? 16U : 0U) | (terms.rolling ? 32U : 0U) |
         (terms.repulsion ? 64U : 0U);
}

constexpr unsigned count_of_codes = 1U << count_of_terms;

}  // namespace peclet::engine
