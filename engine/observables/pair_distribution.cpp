#include "engine/observables/pair_distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "contract/input_error.h"
#include "engine/state/cell_grid.h"

namespace peclet::engine {

namespace {

double setting(const Scene& scene, const char* name) {
  return scene.observables.at("pair_distribution").at(name).get<double>();
}

double shortest(const Vector3& edges) { return std::min({edges.x, edges.y, edges.z}); }

// Pairs within the range must not have other images in the box: it would be ambiguous which is meant.
void check_range(const Scene& scene, const Window& window, const std::string& file) {
  const double unit = scene.particles.reference_radius, range = setting(scene, "range");
  // Beyond half of it the volume of a shell is that in a cube.
  const bool whole_cube = !(scene.physics.flow.rate() > 0) && !scene.height;
  const double reach = whole_cube ? std::numbers::sqrt2 / 2 : 0.5;
  const double edge = shortest(window.box);
  if (range * unit <= reach * edge) return;
  // The default is no part of a scene without the block.
  throw InputError(
      file, "/pair_distribution/range", fmt::format("{}", range),
      fmt::format("must be at most {:.4g} in this box of {:.4g} radii", reach * edge / unit, edge / unit));
}

std::size_t bins_in(double range, double bin) { return static_cast<std::size_t>(std::llround(range / bin)); }

// Centres of the bins, in units of the reference radius. Those of y are r.
struct Axes {
  Json r = Json::array(), x = Json::array();
};

Axes axes_of(double range, double bin) {
  Axes axes;
  const std::size_t bins = bins_in(range, bin);
  for (std::size_t k = 0; k < bins; ++k) axes.r.push_back((static_cast<double>(k) + 0.5) * bin);
  for (std::size_t k = 0; k < 2 * bins; ++k) {
    axes.x.push_back((static_cast<double>(k) + 0.5 - static_cast<double>(bins)) * bin);
  }
  return axes;
}

std::vector<Quantity> distribution_quantities(const Scene& scene, const Window&) {
  const Axes axes = axes_of(setting(scene, "range"), setting(scene, "bin"));
  const char* const unit = "reference radius";
  const RatioOfMeans to_ideal{"counts", "ideal"};
  return {{.name = "pair_distribution/radial",
           .symbol = "g(r)",
           .unit = "1",
           .axes = {{"r", unit, axes.r}},
           .ratio = to_ideal},
          {.name = "pair_distribution/slice",
           .symbol = "g(x, y)",
           .unit = "1",
           .axes = {{"y", unit, axes.r}, {"x", unit, axes.x}},
           .ratio = to_ideal}};
}

}  // namespace

PairDistribution::PairDistribution(const Scene& scene, const System& system, const Window& window)
    : Observable(interval_of(scene, pair_distribution(), window)),
      unit_(scene.particles.reference_radius),
      range_(setting(scene, "range") * unit_),
      bin_(setting(scene, "bin") * unit_),
      slab_(setting(scene, "slab") * unit_),
      edge_(shortest(system.box.lengths())),
      volume_(system.box.volume()),
      particles_(static_cast<double>(system.particles.count())),
      bins_(bins_in(range_, bin_)),
      radial_(bins_),
      radial_quarters_(blocks_kept(bins_) > 0 ? count_of_quarters * bins_ : 0),
      slice_(2 * bins_ * bins_) {}

void PairDistribution::sample(const System& system, std::size_t block) {
  const std::size_t quarter = block * count_of_quarters / count_of_blocks;
  const LatticePlaces places = lattice_places(system.particles.position, system.box);
  std::vector<std::uint32_t> everyone(system.particles.count());
  std::iota(everyone.begin(), everyone.end(), 0U);
  const CellGrid grid(places, everyone, system.box, range_);
  for (std::uint32_t i = 0; i < everyone.size(); ++i) {
    grid.visit_near(places.fractional[i], range_,
                    [&](std::uint32_t j, LatticeShift, const Vector3& separation) {
                      if (j != i) count(separation, quarter);
                    });
  }
  ++samples_;
  ++quarter_samples_[quarter];
}

void PairDistribution::count(const Vector3& r, std::size_t quarter) {
  const double half = 0.5 * edge_;
  // Within half of the box no other image is near.
  if (range_ > half && (std::abs(r.x) > half || std::abs(r.y) > half || std::abs(r.z) > half)) return;
  if (const auto shell = static_cast<std::size_t>(norm(r) / bin_); shell < bins_) {
    ++radial_[shell];
    if (!radial_quarters_.empty()) ++radial_quarters_[quarter * bins_ + shell];
  }
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

double PairDistribution::ideal_pairs(std::uint64_t samples) const {
  return static_cast<double>(samples) * particles_ * (particles_ - 1) / volume_;
}

void PairDistribution::add_to(Json& mean) const {
  const double pairs = ideal_pairs(samples_);
  const Axes axes = axes_of(range_ / unit_, bin_ / unit_);
  Json ideal = Json::array(), rows = Json::array();
  for (std::size_t k = 0; k < bins_; ++k) {
    ideal.push_back(pairs * ideal_shell(k));
    const auto row = slice_.begin() + static_cast<std::ptrdiff_t>(k * 2 * bins_);
    rows.push_back(std::vector<std::uint64_t>(row, row + static_cast<std::ptrdiff_t>(2 * bins_)));
  }
  mean["pair_distribution"] = {
      {"radial", {{"r", axes.r}, {"counts", radial_}, {"ideal", ideal}}},
      {"slice",
       {{"x", axes.x}, {"y", axes.r}, {"counts", rows}, {"ideal", pairs * bin_ * bin_ * 2 * slab_}}}};
}

void PairDistribution::add_blocks_to(Json& blocks) const {
  if (radial_quarters_.empty()) return;
  Json counts = Json::array(), ideal = Json::array();
  for (std::size_t quarter = 0; quarter < count_of_quarters; ++quarter) {
    const auto row = radial_quarters_.begin() + static_cast<std::ptrdiff_t>(quarter * bins_);
    counts.push_back(std::vector<std::uint64_t>(row, row + static_cast<std::ptrdiff_t>(bins_)));
    Json shells = Json::array();
    for (std::size_t k = 0; k < bins_; ++k) {
      shells.push_back(rounded(ideal_pairs(quarter_samples_[quarter]) * ideal_shell(k)));
    }
    ideal.push_back(std::move(shells));
  }
  blocks["pair_distribution"]["radial"] = {{"counts", counts}, {"ideal", ideal}};
}

void PairDistribution::save(ArchiveWriter& archive) const {
  archive.put(samples_);
  archive.put(radial_);
  archive.put(quarter_samples_);
  archive.put(radial_quarters_);
  archive.put(slice_);
}

void PairDistribution::load(ArchiveReader& archive) {
  samples_ = archive.get<std::uint64_t>();
  radial_ = archive.get_vector<std::uint64_t>(radial_.size());
  quarter_samples_ = archive.get<std::array<std::uint64_t, count_of_quarters>>();
  radial_quarters_ = archive.get_vector<std::uint64_t>(radial_quarters_.size());
  slice_ = archive.get_vector<std::uint64_t>(slice_.size());
}

ObservableKind pair_distribution() {
  return {"pair_distribution", seldom, check_range, distribution_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<PairDistribution>(scene, system, window);
          }};
}

}  // namespace peclet::engine
