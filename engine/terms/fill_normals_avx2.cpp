#include "engine/terms/fill_normals.h"

namespace peclet::engine::avx2 {

void fill_normals(const NoiseKey& key, const std::uint64_t* identity, const std::uint64_t* image,
                  NormalBlock& block) {
  fill_block(key, identity, image, block);
}

}  // namespace peclet::engine::avx2
