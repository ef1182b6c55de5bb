#include "engine/observables/pair_distribution.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "contract/input_error.h"
#include "engine/state/cell_grid.h"

namespace peclet::engine {

void check_pair_distribution(const Scene& scene, double edge, const std::string& file) {
  const double unit = scene.particles.reference_radius;
  const double reach = scene.physics.flow.rate() > 0 ? 0.5 : std::numbers::sqrt2 / 2;
  if (scene.pair_distribution->range * unit <= reach * edge) return;
  // The default is no part of a scene without the block.
  throw InputError(
      file, "/pair_distribution/range", fmt::format("{}", scene.pair_distribution->range),
      fmt::format("must be at most {:.4g} in this box of {:.4g} radii", reach * edge / unit, edge / unit));
}

PairDistribution::PairDistribution(const Scene& scene, const System& system, std::uint64_t interval)
    : Observable(interval),
      unit_(scene.particles.reference_radius),
      range_(scene.pair_distribution->range * unit_),
      bin_(scene.pair_distribution->bin * unit_),
      slab_(scene.pair_distribution->slab * unit_),
      edge_(system.box.lengths().x),
      particles_(static_cast<double>(system.particles.count())),
      bins_(static_cast<std::size_t>(std::llround(range_ / bin_))),
      radial_(bins_),
      slice_(2 * bins_ * bins_) {}

void PairDistribution::sample(const System& system) {
  const LatticePlaces places = lattice_places(system.particles.position, system.box);
  std::vector<std::uint32_t> everyone(system.particles.count());
  std::iota(everyone.begin(), everyone.end(), 0U);
  const CellGrid grid(places, everyone, system.box, range_);
  for (std::uint32_t i = 0; i < everyone.size(); ++i) {
    grid.visit_near(places.fractional[i], range_,
                    [&](std::uint32_t j, LatticeShift, const Vector3& separation) {
                      if (j != i) count(separation);
                    });
  }
  ++samples_;
}

void PairDistribution::count(const Vector3& r) {
  const double half = 0.5 * edge_;
  // Within half of the box no other image is near.
  if (range_ > half && (std::abs(r.x) > half || std::abs(r.y) > half || std::abs(r.z) > half)) return;
  if (const auto shell = static_cast<std::size_t>(norm(r) / bin_); shell < bins_) ++radial_[shell];
  if (!(std::abs(r.z) < slab_) || r.y < 0) return;
  const auto row = static_cast<std::size_t>(r.y / bin_);
  const double column = std::floor(r.x / bin_) + static_cast<double>(bins_);
  if (row < bins_ && column >= 0 && column < 2 * static_cast<double>(bins_)) {
    ++slice_[row * 2 * bins_ + static_cast<std::size_t>(column)];
  }
}

// Of the shell's volume, what lies in the cube of nearest images: the integral of 4 pi r^2 up to half of the
// edge and of 4 pi r^2 (3 L / (2 r) - 2) beyond.
double PairDistribution::ideal_shell(std::size_t bin) const {
  const double half = 0.5 * edge_;
  const auto within = [&](double r) {
    const double inner = std::min(r, half);
    double volume = 4 * std::numbers::pi / 3 * inner * inner * inner;
    if (r > half) {
      const auto antiderivative = [&](double x) {
        return 4 * std::numbers::pi * (0.75 * edge_ * x * x - 2.0 / 3 * x * x * x);
      };
      volume += antiderivative(r) - antiderivative(half);
    }
    return volume;
  };
  const auto k = static_cast<double>(bin);
  return within((k + 1) * bin_) - within(k * bin_);
}

void PairDistribution::add_to(Json& mean) const {
  const double volume = edge_ * edge_ * edge_;
  const double pairs = static_cast<double>(samples_) * particles_ * (particles_ - 1) / volume;
  Json radius = Json::array(), ideal = Json::array(), rows = Json::array(), x = Json::array();
  for (std::size_t k = 0; k < bins_; ++k) {
    radius.push_back((static_cast<double>(k) + 0.5) * bin_ / unit_);
    ideal.push_back(pairs * ideal_shell(k));
    const auto row = slice_.begin() + static_cast<std::ptrdiff_t>(k * 2 * bins_);
    rows.push_back(std::vector<std::uint64_t>(row, row + static_cast<std::ptrdiff_t>(2 * bins_)));
  }
  for (std::size_t k = 0; k < 2 * bins_; ++k) {
    x.push_back((static_cast<double>(k) + 0.5 - static_cast<double>(bins_)) * bin_ / unit_);
  }
  mean["pair_distribution"] = {
      {"radial", {{"r", radius}, {"counts", radial_}, {"ideal", ideal}}},
      {"slice", {{"x", x}, {"y", radius}, {"counts", rows}, {"ideal", pairs * bin_ * bin_ * 2 * slab_}}}};
}

void PairDistribution::save(ArchiveWriter& archive) const {
  archive.put(samples_);
  archive.put(radial_);
  archive.put(slice_);
}

void PairDistribution::load(ArchiveReader& archive) {
  samples_ = archive.get<std::uint64_t>();
  radial_ = archive.get_vector<std::uint64_t>(radial_.size());
  slice_ = archive.get_vector<std::uint64_t>(slice_.size());
}

}  // namespace peclet::engine
