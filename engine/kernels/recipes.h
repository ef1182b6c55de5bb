// Every combination of terms that is compiled, in one place.
//
// with_recipe() turns a run-time set of terms into a compile-time one. Two independent choices (repulsion;
// lubrication without or with noise or none) times the ways in which spheres can touch make 42 recipes.
#pragma once

#include <array>
#include <stdexcept>
#include <utility>

#include "engine/kernels/terms.h"

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

constexpr unsigned count_of_codes = 1u << count_of_terms;

// Calls use.template operator()<terms>() with the recipe that equals `terms` and returns what it returns.
// Throws std::invalid_argument for a combination that is not valid.
template <class Use, unsigned code = 0>
auto with_recipe(const Terms& terms, Use&& use) -> decltype(use.template operator()<Terms{}>()) {
  if constexpr (code < count_of_codes) {
    if constexpr (decoded_terms(code).valid()) {
      if (terms == decoded_terms(code)) {
        return use.template operator()<decoded_terms(code)>();
      }
    }
    return with_recipe<Use, code + 1>(terms, std::forward<Use>(use));
  } else {
    throw std::invalid_argument("no kernel is compiled for this combination of terms");
  }
}

}  // namespace peclet::engine
