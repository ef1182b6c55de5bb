// The compiled loops over particles: what they take, and one table of them for each instruction set.
//
// Plain data, because this is shared with files that are compiled for one processor only.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/flow/background_flow.h"

namespace peclet::engine {

struct OneBodyFactors {
  double translational, rotational;
};

// Rows are those of a VectorField; kicks (half a step over mass and moment of inertia) and drag
// (coefficients) are those of each size class.
struct OneBodyInput {
  double *position, *velocity, *spin;
  double *force, *torque;
  const std::uint16_t* size_class;
  const OneBodyFactors *kicks, *drag;
  UniformFlow flow;
};

// Squared speeds relative to the streaming flow.
struct Speeds {
  double largest = 0;
  double sum = 0;  // not finite if one is not; a maximum would pass over it
};

struct OneBodyKernels {
  // velocity += kick force and likewise for spins, of particles [begin, end).
  void (*kick)(const OneBodyInput& in, std::size_t begin, std::size_t end);
  // The same once or twice, and then position += timestep velocity.
  Speeds (*kick_and_drift)(const OneBodyInput& in, std::size_t begin, std::size_t end, bool twice,
                           double timestep);
  // force = drag (streaming velocity - velocity) and likewise for torques.
  void (*set_drag)(const OneBodyInput& in, std::size_t begin, std::size_t end);
  // The last two in one loop.
  Speeds (*kick_drift_and_drag)(const OneBodyInput& in, std::size_t begin, std::size_t end, bool twice,
                                double timestep);
};

extern const OneBodyKernels baseline_one_body_kernels;
extern const OneBodyKernels avx2_one_body_kernels;

}  // namespace peclet::engine
