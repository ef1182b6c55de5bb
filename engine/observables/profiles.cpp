// Profiles along y, the direction of the velocity gradient, in equal bins of the box.
//
// `volume_fraction` is the volume of spheres in a bin over that of the bin; a sphere that reaches into
// several gives each its slab,
//   V(y) = pi h^2 (3 a - h) / 3 below the height y, h = y - (y_i - a) between 0 and 2 a.
// `volume_fraction_by_radius` has the spheres of each radius apart, a list of bins for each; they add up to
// the former.
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
  Profiles(const Scene& scene, const System& system, const Window& window)
      : Observable(interval_of(scene, profiles(), window)),
        bins_(bins_of(scene)),
        volume_fraction_(bins_),
        flux_(bins_),
        of_radius_(distinct_radii(system.particles.radius).size(), BlockedMean(bins_)) {}

  void sample(const System& system, std::size_t block) override {
    const Vector3 lengths = system.box.lengths();
    const double width = lengths.y / static_cast<double>(bins_);
    const double bin_volume = lengths.x * width * lengths.z;
    const ParticleState& particles = system.particles;
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const Vector3 place = particles.position[i];
      const double velocity = particles.velocity[i].x - (system.box.velocity_gradient() * place).x;
      const double a = particles.radius[i];
      BlockedMean& own = of_radius_[particles.size_class[i]];
      const auto count = static_cast<std::int64_t>(bins_);
      const auto last = static_cast<std::int64_t>(std::floor((place.y + a) / width));
      for (auto k = static_cast<std::int64_t>(std::floor((place.y - a) / width)); k <= last; ++k) {
        const double below = static_cast<double>(k) * width - place.y;
        const double share = (volume_below(below + width, a) - volume_below(below, a)) / bin_volume;
        const auto bin = static_cast<std::size_t>((k % count + count) % count);
        volume_fraction_.add(block, bin, share);
        flux_.add(block, bin, share * velocity);
        own.add(block, bin, share);
      }
    }
    for_each([&](auto& mean) { mean.weigh(block, 1); });
  }

  void add_to(Json& mean) const override {
    Json by_radius = Json::array();
    for (const BlockedMean& own : of_radius_) by_radius.push_back(own.value());
    mean["profiles"] = of(volume_fraction_.value(), flux_.value(), by_radius);
  }
  void add_blocks_to(Json& blocks) const override {
    if (blocks_kept(bins_) == 0) return;
    Json by_radius(count_of_quarters, Json::array());  // in each quarter all radii
    for (const BlockedMean& own : of_radius_) {
      const Json quarters = own.blocks();
      for (std::size_t k = 0; k < count_of_quarters; ++k) by_radius[k].push_back(quarters[k]);
    }
    blocks["profiles"] = of(volume_fraction_.blocks(), flux_.blocks(), by_radius);
  }

  void save(ArchiveWriter& archive) const override {
    volume_fraction_.save(archive);
    flux_.save(archive);
    for (const BlockedMean& own : of_radius_) own.save(archive);
  }
  void load(ArchiveReader& archive) override {
    for_each([&](auto& mean) { mean.load(archive); });
  }

 private:
  template <class Function>
  void for_each(Function&& function) {
    function(volume_fraction_);
    function(flux_);
    for (BlockedMean& own : of_radius_) function(own);
  }

  static Json of(const Json& volume_fraction, const Json& flux, const Json& by_radius) {
    return {{"volume_fraction", volume_fraction},
            {"volume_fraction_by_radius", by_radius},
            {"velocity", {{"flux", flux}, {"volume_fraction", volume_fraction}}}};
  }

  std::size_t bins_;
  BlockedMean volume_fraction_, flux_;
  std::vector<BlockedMean> of_radius_;
};

std::vector<Quantity> profile_quantities(const Scene& scene, const Window& window) {
  Axis y{"y", "length", Json::array()};
  const std::size_t bins = bins_of(scene);
  for (std::size_t k = 0; k < bins; ++k) {
    y.values.push_back((static_cast<double>(k) + 0.5) * window.edge / static_cast<double>(bins));
  }
  const Axis radius{"radius", "length", radii_in(scene)};
  return {
      {.name = "profiles/volume_fraction", .symbol = "phi(y)", .unit = "1", .axes = {y}},
      {.name = "profiles/volume_fraction_by_radius", .symbol = "phi_a(y)", .unit = "1", .axes = {radius, y}},
      {.name = "profiles/velocity",
       .symbol = "u_x(y) - U(y)",
       .unit = "length / time",
       .axes = {y},
       .ratio = RatioOfMeans{"flux", "volume_fraction"}}};
}

}  // namespace

ObservableKind profiles() {
  return {"profiles", seldom, [](const Scene&, const Window&, const std::string&) {}, profile_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<Profiles>(scene, system, window);
          }};
}

}  // namespace peclet::engine
