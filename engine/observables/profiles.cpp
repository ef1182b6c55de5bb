// Profiles along y, the direction of the velocity gradient, in equal bins of the box.
//
// `volume_fraction` is the volume of spheres in a bin over that of the bin; a sphere that reaches into
// several gives each its slab,
//   V(y) = pi h^2 (3 a - h) / 3 below the height y, h = y - (y_i - a) between 0 and 2 a.
// `velocity` is the mean of u_x - U(y_i), with each sphere's part V_i of the bin as its weight; U is the
// uniform part of the flow. A ratio of means: numerator sum V_i (u_x - U) and denominator sum V_i, both over
// the bin's volume.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/observables/blocked_mean.h"
#include "engine/observables/kinds.h"

namespace peclet::engine {
namespace {

std::size_t bins_of(const Scene& scene) {
  return scene.observables.at("profiles").at("bins").get<std::size_t>();
}

// Of a sphere of radius a around 0, what lies below y.
double volume_below(double y, double a) {
  const double h = std::clamp(y + a, 0.0, 2 * a);
  return std::numbers::pi * h * h * (3 * a - h) / 3;
}

class Profiles : public Observable {
 public:
  Profiles(const Scene& scene, const Window& window)
      : Observable(interval_of(scene, profiles(), window)),
        bins_(bins_of(scene)),
        volume_fraction_(bins_),
        flux_(bins_) {}

  void sample(const System& system, std::size_t block) override {
    const Vector3 lengths = system.box.lengths();
    const double width = lengths.y / static_cast<double>(bins_);
    const double bin_volume = lengths.x * width * lengths.z;
    const ParticleState& particles = system.particles;
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const Vector3 place = particles.position[i];
      const double velocity = particles.velocity[i].x - (system.box.velocity_gradient() * place).x;
      const double a = particles.radius[i];
      const auto count = static_cast<std::int64_t>(bins_);
      const auto last = static_cast<std::int64_t>(std::floor((place.y + a) / width));
      for (auto k = static_cast<std::int64_t>(std::floor((place.y - a) / width)); k <= last; ++k) {
        const double below = static_cast<double>(k) * width - place.y;
        const double share = (volume_below(below + width, a) - volume_below(below, a)) / bin_volume;
        const auto bin = static_cast<std::size_t>((k % count + count) % count);
        volume_fraction_.add(block, bin, share);
        flux_.add(block, bin, share * velocity);
      }
    }
    volume_fraction_.weigh(block, 1);
    flux_.weigh(block, 1);
  }

  void add_to(Json& mean) const override { mean["profiles"] = of(volume_fraction_.value(), flux_.value()); }
  void add_blocks_to(Json& blocks) const override {
    if (blocks_kept(bins_) > 0) blocks["profiles"] = of(volume_fraction_.blocks(), flux_.blocks());
  }

  void save(ArchiveWriter& archive) const override {
    volume_fraction_.save(archive);
    flux_.save(archive);
  }
  void load(ArchiveReader& archive) override {
    volume_fraction_.load(archive);
    flux_.load(archive);
  }

 private:
  static Json of(const Json& volume_fraction, const Json& flux) {
    return {{"volume_fraction", volume_fraction},
            {"velocity", {{"flux", flux}, {"volume_fraction", volume_fraction}}}};
  }

  std::size_t bins_;
  BlockedMean volume_fraction_, flux_;
};

std::vector<Quantity> profile_quantities(const Scene& scene, const Window& window) {
  Axis y{"y", "length", Json::array()};
  const std::size_t bins = bins_of(scene);
  for (std::size_t k = 0; k < bins; ++k) {
    y.values.push_back((static_cast<double>(k) + 0.5) * window.edge / static_cast<double>(bins));
  }
  return {{.name = "profiles/volume_fraction", .symbol = "phi(y)", .unit = "1", .axes = {y}},
          {.name = "profiles/velocity",
           .symbol = "u_x(y) - U(y)",
           .unit = "length / time",
           .axes = {y},
           .ratio = RatioOfMeans{"flux", "volume_fraction"}}};
}

}  // namespace

ObservableKind profiles() {
  return {"profiles", seldom, [](const Scene&, const Window&, const std::string&) {}, profile_quantities,
          [](const Scene& scene, const System&, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<Profiles>(scene, window);
          }};
}

}  // namespace peclet::engine
