// The loops over particles, compiled once for each register width. A row is a vector, so particles one by one
// are as fast as several side by side.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/kernels/one_body_kernels.h"
#include "engine/kernels/streaming.h"

namespace peclet::engine {
namespace {

// NOLINTNEXTLINE(readability-non-const-parameter): callers write to the row
inline Row& row(double* rows, std::size_t i) { return reinterpret_cast<Row*>(rows)[i]; }

void kick(const OneBodyInput& in, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const OneBodyFactors& factor = in.kicks[in.size_class[i]];
    row(in.velocity, i) += factor.translational * row(in.force, i);
    row(in.spin, i) += factor.rotational * row(in.torque, i);
  }
}

// Sets the rows of a particle to its drag in the uniform flow.
template <bool is_simple_shear>
void set_drag(const OneBodyInput& in, const OneBodyFactors& drag, std::size_t i, const Row& position,
              const Row& velocity, const Row& spin) {
  Row streaming;
  set_streaming<is_simple_shear>(in.flow, position, streaming);
  row(in.force, i) = drag.translational * (streaming - velocity);
  row(in.torque, i) = drag.rotational * (streaming_spin(in.flow) - spin);
}

template <bool twice, bool dragged, bool is_simple_shear>
Speeds kick_and_drift(const OneBodyInput& in, std::size_t begin, std::size_t end, double timestep) {
  Speeds speeds;
  Row sum{};
  for (std::size_t i = begin; i < end; ++i) {
    const OneBodyFactors& factor = in.kicks[in.size_class[i]];
    const Row change = factor.translational * row(in.force, i), turn = factor.rotational * row(in.torque, i);
    Row u = row(in.velocity, i) + change, w = row(in.spin, i) + turn;
    if constexpr (twice) {
      u += change;
      w += turn;
    }
    const Row x = row(in.position, i);
    Row streaming;
    set_streaming<is_simple_shear>(in.flow, x, streaming);
    const Row peculiar = u - streaming;
    const Row squares = peculiar * peculiar;
    const double squared = squares[0] + squares[1] + squares[2];
    speeds.largest = speeds.largest > squared ? speeds.largest : squared;
    sum += squares;
    row(in.velocity, i) = u;
    row(in.spin, i) = w;
    const Row drifted = x + timestep * u;
    row(in.position, i) = drifted;
    if constexpr (dragged) {
      set_drag<is_simple_shear>(in, in.drag[in.size_class[i]], i, drifted, u, w);
    }
  }
  speeds.sum = sum[0] + sum[1] + sum[2];
  return speeds;
}

template <bool dragged>
Speeds kick_and_drift(const OneBodyInput& in, std::size_t begin, std::size_t end, bool twice,
                      double timestep) {
  if (in.flow.is_simple_shear) {
    return twice ? kick_and_drift<true, dragged, true>(in, begin, end, timestep)
                 : kick_and_drift<false, dragged, true>(in, begin, end, timestep);
  }
  return twice ? kick_and_drift<true, dragged, false>(in, begin, end, timestep)
               : kick_and_drift<false, dragged, false>(in, begin, end, timestep);
}

template <bool is_simple_shear>
void set_drags(const OneBodyInput& in, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    set_drag<is_simple_shear>(in, in.drag[in.size_class[i]], i, row(in.position, i), row(in.velocity, i),
                              row(in.spin, i));
  }
}

void set_drag(const OneBodyInput& in, std::size_t begin, std::size_t end) {
  in.flow.is_simple_shear ? set_drags<true>(in, begin, end) : set_drags<false>(in, begin, end);
}

}  // namespace
}  // namespace peclet::engine
