// Computes the uniform flow at the position of a particle; simple shear needs one product instead of three.
//
// Everything is static, for the reason given in one_body.h.
#pragma once

#include "engine/flow/background_flow.h"
#include "engine/state/real.h"

namespace peclet::engine {
namespace {

template <bool is_simple_shear>
PECLET_ALWAYS_INLINE void set_streaming(const UniformFlow& flow, const Row& position, Row& velocity) {
  if constexpr (is_simple_shear) {
    velocity = Row{flow.gradient[1][0] * position[1], 0, 0, 0};
  } else {
    const auto* column = reinterpret_cast<const Row*>(flow.gradient);
    velocity = position[0] * column[0] + position[1] * column[1] + position[2] * column[2];
  }
}

PECLET_ALWAYS_INLINE const Row& streaming_spin(const UniformFlow& flow) {
  return *reinterpret_cast<const Row*>(flow.spin);
}

}  // namespace
}  // namespace peclet::engine
