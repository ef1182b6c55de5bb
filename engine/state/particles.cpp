#include "engine/state/particles.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "engine/state/archive.h"
#include "engine/state/neighbour_list.h"

namespace peclet::engine {

std::vector<double> distinct_radii(const std::vector<double>& radius) {
  std::vector<double> distinct = radius;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return distinct;
}

ParticleState make_particles(const std::vector<double>& radius, double density) {
  return make_particles(radius, std::vector<double>(radius.size(), density));
}

ParticleState make_particles(const std::vector<double>& radius, const std::vector<double>& density) {
  ParticleState particles;
  particles.radius = radius;
  const std::vector<double> sizes = distinct_radii(radius);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double a = radius[i], mass = 4.0 / 3.0 * std::numbers::pi * density[i] * a * a * a;
    particles.mass.push_back(mass);
    particles.inertia.push_back(0.4 * mass * a * a);
    const auto place = std::lower_bound(sizes.begin(), sizes.end(), a);
    particles.size_class.push_back(static_cast<std::uint16_t>(place - sizes.begin()));
  }
  particles.position = particles.velocity = particles.angular_velocity = VectorField(radius.size());
  particles.image.resize(radius.size());
  particles.id.resize(radius.size());
  std::iota(particles.id.begin(), particles.id.end(), 0U);
  return particles;
}

void wrap_into_cell(ParticleState& particles, const PeriodicCell& box) {
  const CellFrame frame = box.frame();
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 place = frame.fractional(particles.position[i]);
    const LatticeShift removed = {static_cast<std::int32_t>(std::floor(place.x)),
                                  static_cast<std::int32_t>(std::floor(place.y)),
                                  static_cast<std::int32_t>(std::floor(place.z))};
    if (removed == LatticeShift{}) continue;
    particles.position.set(i, particles.position[i] - box.displacement(removed));
    particles.velocity.add(i, -box.velocity(removed));
    particles.image[i] = particles.image[i] + removed;
  }
}

double solid_volume(const std::vector<double>& radius) {
  double volume = 0;
  for (const double a : radius) {
    volume += 4.0 / 3.0 * std::numbers::pi * a * a * a;
  }
  return volume;
}

namespace {

constexpr double cells_per_edge = 1 << 10;

// Returns the ten bits of `x` with two zeros after each.
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
  for (const std::uint32_t from : order) arranged.push_back(values[from]);
  values = std::move(arranged);
}

void permute(VectorField& field, const std::vector<std::uint32_t>& order, int threads) {
  VectorField arranged(field.size(), threads);
  for_each_index(order.size(), threads, [&](std::size_t i) { arranged.row(i) = field.row(order[i]); });
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
  if (count_of_particle_blocks(particles.count()) == 1) return;
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
