// The program that cards run: one variant, which PECLET_CARD_VARIANT names. It is compiled by clang into PTX,
// without a CUDA toolkit, and is no part of the engine's libraries.
#ifdef __CUDA__  // g++ sees an empty file

#define __host__ __attribute__((host))  // NOLINT(bugprone-reserved-identifier): clang's own headers use it
#define __device__ __attribute__((device))  // NOLINT(bugprone-reserved-identifier)
#define __global__ __attribute__((global))  // NOLINT(bugprone-reserved-identifier)
#define __shared__ __attribute__((shared))  // NOLINT(bugprone-reserved-identifier)

// Headers of the library are for the host; what follows them is for both.
#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#pragma clang force_cuda_host_device begin
#include "engine/card/card_variants.h"
#pragma clang force_cuda_host_device end

#ifndef PECLET_CARD_BLOCKS
#define PECLET_CARD_BLOCKS 1  // realisations at once on a multiprocessor
#endif

extern "C" __global__ __attribute__((launch_bounds(PECLET_CARD_THREADS, PECLET_CARD_BLOCKS))) void advance(
    const peclet::engine::CardSlot* slots, peclet::engine::CardBounds bounds) {
  using namespace peclet::engine;
  extern __shared__ CardMotion scaled[];
  alignas(16) __shared__ unsigned char near[sizeof(CardNear)];
  const CardTeam team;
  advance_slot<PECLET_CARD_VARIANT>(slots[__nvvm_read_ptx_sreg_ctaid_x()], reinterpret_cast<CardNear&>(near),
                                    scaled, team, bounds);
}

#endif
