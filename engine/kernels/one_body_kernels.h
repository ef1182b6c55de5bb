// The compiled loops over particles: their input, and one table of them for each instruction set.
//
// Plain data, because files that are compiled for one processor only include this header.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/flow/background_flow.h"

namespace peclet::engine {

struct OneBodyFactors {
  double translational, rotational;
};

// The input of the loops: rows of VectorFields, and for each size class kicks (half a step over mass and
// moment of inertia) and drag coefficients.
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
  double sum = 0;  // not finite if a speed is not, which `largest` may miss
};

struct OneBodyKernels {
  // Adds kick * force to velocities, and likewise to spins, of particles [begin, end).
  void (*kick)(const OneBodyInput& in, std::size_t begin, std::size_t end);
  // Kicks once or twice, then adds timestep * velocity to positions.
  Speeds (*kick_and_drift)(const OneBodyInput& in, std::size_t begin, std::size_t end, bool twice,
                           double timestep);
  // Sets force = drag (streaming velocity - velocity), and likewise torques.
  void (*set_drag)(const OneBodyInput& in, std::size_t begin, std::size_t end);
  // Does kick_and_drift and set_drag in one loop.
  Speeds (*kick_drift_and_drag)(const OneBodyInput& in, std::size_t begin, std::size_t end, bool twice,
                                double timestep);
};

extern const OneBodyKernels baseline_one_body_kernels;
extern const OneBodyKernels avx2_one_body_kernels;

}  // namespace peclet::engine
