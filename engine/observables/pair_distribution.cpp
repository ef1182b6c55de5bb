// Measures the distribution of other particles around a particle.
//
// Every sample counts the separations r = x_j - x_i of all ordered pairs (i, j), each to the nearest image:
// `radial` by |r| in shells of thickness `bin`, `slice` by (x, y) in squares of edge `bin`, if |z| is below
// `slab`. The result also has the ideal counts of uncorrelated points, N (N - 1) / V times the volume of the
// bin and the number of samples. Then g = counts / ideal, and counts of several realisations may be added up.
// Lengths are in units of the reference radius a. The slice has y >= 0 only: every pair is counted from both
// ends, and the other half is the reflection of this one through the origin. counts[row][column] has y in the
// row and x in the column.
//
// The nearest image is unique up to half of the edge L of the box. In a cube at rest, for pairs in a small
// box, the range may be up to L / sqrt(2). Shells beyond L / 2 lie partly outside the cube of nearest images.
// Their ideal count has the factor 3 L / (2 r) - 2, the share of the sphere's surface inside.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contract/errors.h"
#include "engine/observables/observable.h"
#include "engine/observables/structure.h"

namespace peclet::engine {
namespace {

constexpr double most_bins = 1000;

// Lengths in units of the reference radius.
struct DistributionSettings {
  double range, bin, slab;

  std::size_t bins() const { return static_cast<std::size_t>(std::llround(range / bin)); }
};

double shortest(const Vector3& edges) { return std::min({edges.x, edges.y, edges.z}); }

// Throws InputError if the nearest image of a pair within the range is not unique.
void check_range(const Plan& plan, double range) {
  const Scene& scene = plan.scene;
  const double unit = scene.particles.reference_radius;
  // Volumes of shells beyond half of the edge are those in a cube.
  const bool whole_cube = !(scene.physics.flow.rate() > 0) && !scene.height;
  const double reach = whole_cube ? std::numbers::sqrt2 / 2 : 0.5;
  const double edge = shortest(plan.window.box);
  if (range * unit <= reach * edge) return;
  // The scene may lack the block, so the value is given here.
  throw InputError(plan.file, "/pair_distribution/range", fmt::format("{}", range),
                   fmt::format("must be at most {:.4g} in this box, whose shortest edge is {:.4g}",
                               reach * edge / unit, edge / unit));
}

// Returns the axis of the centres of `count` bins, of which the first one begins at `from` bins.
Axis bins_along(const char* name, const DistributionSettings& settings, std::size_t count, double from) {
  return axis_of(name, "reference radius", count,
                 [&](std::size_t k) { return (static_cast<double>(k) + 0.5 + from) * settings.bin; });
}

class PairDistribution : public Observable {
 public:
  PairDistribution(const Plan& plan, const DistributionSettings& settings)
      : Observable(plan),
        range_(settings.range * plan.scene.particles.reference_radius),
        bin_(settings.bin * plan.scene.particles.reference_radius),
        slab_(settings.slab * plan.scene.particles.reference_radius),
        edge_(shortest(plan.window.box)),
        volume_(plan.window.volume()),
        particles_(static_cast<double>(plan.scene.particles.count)),
        bins_(settings.bins()) {
    check_range(plan, settings.range);
    radial_.resize(bins_);
    radial_quarters_.resize(blocks_kept({bins_}) > 0 ? count_of_quarters * bins_ : 0);
    slice_.resize(2 * bins_ * bins_);
    const RatioOfMeans to_ideal{"counts", "ideal"};
    const Axis r = bins_along("r", settings, bins_, 0), y = bins_along("y", settings, bins_, 0);
    const Axis x = bins_along("x", settings, 2 * bins_, -static_cast<double>(bins_));
    derive(
        {.name = "pair_distribution/radial", .symbol = "g(r)", .unit = "1", .axes = {r}, .ratio = to_ideal},
        [=, this] { return radial(r.values); }, [this] { return radial_blocks(); });
    derive({.name = "pair_distribution/slice",
            .symbol = "g(x, y)",
            .unit = "1",
            .axes = {y, x},
            .ratio = to_ideal},
           [=, this] { return slice(x.values, y.values); });
    keep(samples_, radial_, quarter_samples_, radial_quarters_, slice_);
  }

  void sample(const System& system, std::size_t block) override {
    const std::size_t quarter = block * count_of_quarters / count_of_blocks;
    for_each_near_pair(system, range_, [&](std::uint32_t, std::uint32_t, const Vector3& separation) {
      count(separation, quarter);
    });
    ++samples_;
    ++quarter_samples_[quarter];
  }

 private:
  void count(const Vector3& r, std::size_t quarter) {
    const double half = 0.5 * edge_;
    // Beyond half of the edge, skips images that are not the nearest.
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

  // Returns the volume of a shell within the cube of nearest images: the integral of 4 pi r^2 up to half of
  // the edge and of 4 pi r^2 (3 L / (2 r) - 2) beyond.
  double ideal_shell(std::size_t bin) const {
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

  // Returns the ordered pairs of uncorrelated points per volume, in `samples` samples.
  double ideal_pairs(std::uint64_t samples) const {
    return static_cast<double>(samples) * particles_ * (particles_ - 1) / volume_;
  }

  // Returns the counts in rows of this length.
  static Json rows(const std::vector<std::uint64_t>& counts, std::size_t length) {
    Json rows = Json::array();
    for (auto row = counts.begin(); row != counts.end(); row += static_cast<std::ptrdiff_t>(length)) {
      rows.push_back(std::vector<std::uint64_t>(row, row + static_cast<std::ptrdiff_t>(length)));
    }
    return rows;
  }
  Json ideal_shells(std::uint64_t samples) const {
    Json ideal = Json::array();
    for (std::size_t k = 0; k < bins_; ++k) ideal.push_back(ideal_pairs(samples) * ideal_shell(k));
    return ideal;
  }

  Json radial(const Json& r) const {
    return {{"r", r}, {"counts", radial_}, {"ideal", ideal_shells(samples_)}};
  }
  Json slice(const Json& x, const Json& y) const {
    return {{"x", x},
            {"y", y},
            {"counts", rows(slice_, 2 * bins_)},
            {"ideal", ideal_pairs(samples_) * bin_ * bin_ * 2 * slab_}};
  }
  Json radial_blocks() const {
    if (radial_quarters_.empty()) return nullptr;
    Json ideal = Json::array();
    for (const std::uint64_t samples : quarter_samples_) ideal.push_back(rounded(ideal_shells(samples)));
    return {{"counts", rows(radial_quarters_, bins_)}, {"ideal", ideal}};
  }

  double range_, bin_, slab_;  // lengths
  double edge_, volume_;       // the shortest edge of the box
  double particles_;
  std::size_t bins_;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> radial_;
  // Quarters of the window; too many bins are not kept in quarters.
  std::array<std::uint64_t, count_of_quarters> quarter_samples_{};
  std::vector<std::uint64_t> radial_quarters_;  // rows of bins_
  std::vector<std::uint64_t> slice_;            // rows of 2 bins_
};

MakeFromPlan read_distribution(const SceneDocument& document, const Scene&) {
  const auto setting = [&](const char* name) {
    return document.number(std::string("/pair_distribution/") + name);
  };
  const DistributionSettings settings{setting("range"), setting("bin"), setting("slab")};
  const double bins = settings.range / settings.bin;
  if (std::abs(bins - std::round(bins)) > 1e-9 * bins || bins < 1 || bins > most_bins) {
    document.refuse("/pair_distribution/bin",
                    "must divide /pair_distribution/range, which is {}, into 1 to {} equal parts",
                    shortened(document.at("/pair_distribution/range")), most_bins);
  }
  return maker<PairDistribution>(settings);
}

}  // namespace

ObservableKind pair_distribution() {
  return {.name = "pair_distribution",
          .meaning = "g(r) and g(x, y)",
          .settings = R"(
/pair_distribution/range | number > 0; in reference radius; default 4 | Largest distance: at most half of the
    shortest edge of the box, or 0.707 of it in a cube at rest.
/pair_distribution/bin | number > 0; in reference radius; default 0.1 | Width of a bin; must divide the range
    into at most 1000 equal bins.
/pair_distribution/slab | number > 0; in reference radius; default 0.1 | Distance |z| below which a pair
    counts for g(x, y).
)",
          .read = read_distribution};
}

}  // namespace peclet::engine
