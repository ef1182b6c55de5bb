// The table of pair kernels of one number, by the code of their recipe.
//
// Included by one file for each instruction set, compiled with its flags: see pair_kernel.h.
#pragma once

#include <utility>

#include "engine/kernels/pairs/pair_kernel.h"

namespace peclet::engine {

template <class Real, unsigned code>
constexpr PairKernel kernel_of_code() {
  constexpr Terms terms = decoded_terms(code);
  if constexpr (terms.valid() && compiled_terms(terms) == terms) {
    return &run_pair_kernel<Real, terms>;
  } else {
    return nullptr;
  }
}

template <class Real, unsigned... codes>
constexpr PairKernelTable make_pair_kernels(std::integer_sequence<unsigned, codes...> /*codes*/) {
  return {{kernel_of_code<Real, codes>()...}};
}

template <class Real>
constexpr PairKernelTable pair_kernels_of() {
  return make_pair_kernels<Real>(std::make_integer_sequence<unsigned, count_of_codes>{});
}

}  // namespace peclet::engine
