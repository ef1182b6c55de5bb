#include "engine/random/keyed_random.h"

#include <Random123/threefry.h>

#include "engine/random/box_muller.h"

namespace peclet::engine {
namespace {

std::uint32_t low(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
std::uint32_t high(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); }

NormalPair normal_pair(const std::array<std::uint64_t, 4>& words) {
  const TwoNormals p = box_muller(low(words[0]), high(words[0]));
  const TwoNormals q = box_muller(low(words[1]), high(words[1]));
  const TwoNormals r = box_muller(low(words[2]), high(words[2]));
  return {{p.a, p.b, q.a}, {q.b, r.a, r.b}};
}

}  // namespace

std::array<std::uint64_t, 4> KeyedRandom::bits(std::uint64_t step, std::uint64_t identity,
                                               std::uint64_t image) const {
  const threefry4x64_ctr_t counter = {{step, identity, image, 0}};
  const threefry4x64_key_t key = {{seed_, purpose_, 0, 0}};
  const threefry4x64_ctr_t out = threefry4x64(counter, key);
  return {out.v[0], out.v[1], out.v[2], out.v[3]};
}

NormalPair KeyedRandom::normals(std::uint64_t step, std::uint32_t particle) const {
  return normal_pair(bits(step, particle, 0));
}

NormalPair KeyedRandom::normals(std::uint64_t step, std::uint32_t first, std::uint32_t second,
                                LatticeShift image) const {
  const std::uint64_t identity = std::uint64_t{second} << 32 | first;
  // Shifts between neighbours are a few lattice vectors; 21 bits hold each.
  constexpr std::uint64_t mask = (1u << 21) - 1;
  const std::uint64_t shift = (static_cast<std::uint64_t>(image.x) & mask) |
                              (static_cast<std::uint64_t>(image.y) & mask) << 21 |
                              (static_cast<std::uint64_t>(image.z) & mask) << 42;
  return normal_pair(bits(step, identity, shift));
}

Vector3 KeyedRandom::uniforms(std::uint64_t step, std::uint32_t particle) const {
  const auto words = bits(step, particle, 0);
  const auto unit = [](std::uint64_t word) { return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52; };
  return {unit(words[0]), unit(words[1]), unit(words[2])};
}

}  // namespace peclet::engine
