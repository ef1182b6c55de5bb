#include "engine/state/particle_order.h"

#include <algorithm>
#include <numeric>

#include "engine/state/archive.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {
namespace {

constexpr double cells_per_edge = 1 << 10;

// Ten bits, two zeros between each and the next.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffU;
  x = (x | x << 8) & 0x0300f00fU;
  x = (x | x << 4) & 0x030c30c3U;
  return (x | x << 2) & 0x09249249U;
}

std::uint32_t morton_code(const Vector3& fractional) {
  const auto cell = [](double x) {
    return spread_bits(static_cast<std::uint32_t>(std::clamp(x * cells_per_edge, 0.0, cells_per_edge - 1)));
  };
  return cell(fractional.x) | cell(fractional.y) << 1 | cell(fractional.z) << 2;
}

template <class Value>
void permute(std::vector<Value>& values, const std::vector<std::uint32_t>& order) {
  std::vector<Value> arranged;
  arranged.reserve(values.size());
  for (const std::uint32_t from : order) {
    arranged.push_back(values[from]);
  }
  values = std::move(arranged);
}

void permute(VectorField& field, const std::vector<std::uint32_t>& order, int threads) {
  VectorField arranged(field.size(), threads);
  for_each_range(order.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      arranged.row(i) = field.row(order[i]);
    }
  });
  field = std::move(arranged);
}

void permute(ParticleState& particles, const std::vector<std::uint32_t>& order, int threads) {
  permute(particles.radius, order);
  permute(particles.mass, order);
  permute(particles.inertia, order);
  permute(particles.size_class, order);
  permute(particles.id, order);
  permute(particles.position, order, threads);
  permute(particles.velocity, order, threads);
  permute(particles.angular_velocity, order, threads);
  permute(particles.image, order);
}

}  // namespace

void arrange_along_curve(ParticleState& particles, const PeriodicCell& box, int threads) {
  if (count_of_particle_blocks(particles.count()) == 1) {
    return;
  }
  const CellFrame frame = box.frame();
  std::vector<std::uint32_t> code, order(particles.count());
  code.reserve(particles.count());
  for (std::size_t i = 0; i < particles.count(); ++i) {
    code.push_back(morton_code(frame.fractional(particles.position[i])));
  }
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
  permute(particles, order, threads);
}

void arrange_by_id(ParticleState& particles, const std::vector<std::uint32_t>& id) {
  std::vector<bool> seen(particles.count());
  for (const std::uint32_t i : id) {
    if (i >= particles.count() || seen[i]) {
      throw ArchiveError("numbers its particles twice or beyond their count");
    }
    seen[i] = true;
  }
  permute(particles, id, 1);
}

}  // namespace peclet::engine
