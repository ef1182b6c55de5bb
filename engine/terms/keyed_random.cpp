#include "engine/terms/keyed_random.h"

#include <Random123/threefry.h>

namespace peclet::engine {
namespace {

NormalPair first_of_block(const NoiseKey& key, std::uint64_t identity, std::uint64_t image) {
  const std::uint64_t identities[identities_per_block] = {identity}, images[identities_per_block] = {image};
  NormalBlock block;
  baseline::fill_normals(key, identities, images, block);
  const auto normal = [&block](int k) { return static_cast<double>(block.value[k][0]); };
  return {{normal(0), normal(1), normal(2)}, {normal(3), normal(4), normal(5)}};
}

}  // namespace

NormalPair KeyedRandom::normals(std::uint64_t step, std::uint32_t particle) const {
  return first_of_block(key(step), particle, 0);
}

NormalPair KeyedRandom::normals(std::uint64_t step, std::uint32_t first, std::uint32_t second,
                                LatticeShift image) const {
  return first_of_block(key(step), pair_identity(first, second), image_identity(image));
}

Vector3 KeyedRandom::uniforms(std::uint64_t step, std::uint32_t particle) const {
  const threefry2x64_ctr_t counter = {{step, particle}};
  const threefry2x64_key_t threefry_key = {{seed_, purpose_ << 60}};
  const threefry2x64_ctr_t words = threefry2x64_R(20, counter, threefry_key);
  constexpr std::uint64_t mask = (std::uint64_t{1} << 42) - 1;
  const auto unit = [](std::uint64_t bits) { return (static_cast<double>(bits & mask) + 0.5) * 0x1p-42; };
  return {unit(words.v[0]), unit(words.v[0] >> 42 | words.v[1] << 22), unit(words.v[1] >> 20)};
}

}  // namespace peclet::engine
