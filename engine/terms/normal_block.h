// The noise of eight particles or pairs.
#pragma once

#include <cstdint>

namespace peclet::engine {

// Standard normal numbers for eight particles or pairs at once: the one source of every noise.
//
// Each identity has six independent normals, a pure function of (key, step, identity, image).
// Threefry-2x64-20 (Salmon et al. 2011) gives 128 bits; three Box-Muller transforms of 21-bit uniforms in
// single precision turn them into normals. Every operation is exact or rounded on its own (products are never
// fused with sums), so the bits are the same on every instruction set.
//
// The noise of a divided step is refined: of a part with the normal z, and y another one that is keyed by
// that part, the halves have (z + y)/sqrt 2 and (z - y)/sqrt 2. Both are standard normal and independent, and
// sqrt(dt/2) times their sum is sqrt(dt) z: the same Wiener path, however a step is divided (Levy 1948).
constexpr int identities_per_block = 8;

struct NoiseKey {
  std::uint64_t seed = 0, purpose = 0, step = 0;
  std::uint64_t part = 1;  // of the step: 1 is all of it, 2 p and 2 p + 1 are the halves of p
};

// What keys the noise of a pair besides its step. `first` < `second` fixes the sign of the pair's forces.
[[gnu::always_inline]] inline std::uint64_t pair_identity(std::uint32_t first, std::uint32_t second) {
  return std::uint64_t{second} << 32 | first;
}

struct NormalBlock {
  alignas(64) float value[6][identities_per_block];
};

// Fills a block for eight identities. `image` may be null: all zero.
using FillNormals = void (*)(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                             NormalBlock& block);

namespace baseline {
void fill_normals(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                  NormalBlock& block);
}
namespace avx2 {
void fill_normals(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                  NormalBlock& block);
}
namespace avx512 {
void fill_normals(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                  NormalBlock& block);
}

}  // namespace peclet::engine
