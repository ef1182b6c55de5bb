// fill_normals() gives the noise of eight particles or pairs.
#pragma once

#include <cstdint>

namespace peclet::engine {

// Each particle or pair (identity) has six independent standard normal numbers, a pure function of (key,
// step, identity, image). Threefry-2x64-20 (Salmon et al. 2011) gives 128 bits. Three Box-Muller transforms
// of 21-bit uniforms in single precision turn them into normals. Every operation is exact or rounded by
// itself (products are never fused with sums), so every instruction set gives the same bits.
//
// The noise of a divided step is refined. If a part has the normal z, and y is another normal keyed by that
// part, its halves have (z + y)/sqrt 2 and (z - y)/sqrt 2. Both are standard normal and independent, and
// sqrt(dt/2) times their sum is sqrt(dt) z: the Wiener path does not depend on the division (Levy 1948).
constexpr int identities_per_block = 8;

struct NoiseKey {
  std::uint64_t seed = 0, purpose = 0, step = 0;
  std::uint64_t part = 1;  // 1 is the whole step, 2 p and 2 p + 1 are the halves of p
};

// Returns the identity of a pair. `first` < `second` fixes the sign of the pair's forces.
[[gnu::always_inline]] inline std::uint64_t pair_identity(std::uint32_t first, std::uint32_t second) {
  return std::uint64_t{second} << 32 | first;
}

template <int width>
struct NormalBlockOf {
  alignas(8 * width) float value[6][width];
};
using NormalBlock = NormalBlockOf<identities_per_block>;

// Fills a block for eight identities. `image` may be null if all images are zero.
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
