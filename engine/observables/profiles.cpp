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
// `stress`, `momentum_flux`, `drag` and `momentum_imbalance`: stress_profile.h; `velocity_variance`:
// velocity_variance.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/averages/blocked_mean.h"
#include "engine/observables/kinds.h"
#include "engine/observables/stress_profile.h"
#include "engine/observables/velocity_variance.h"

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
        of_radius_(distinct_radii(system.particles.radius).size(), BlockedMean(bins_)),
        stress_(scene.physics, bins_),
        variance_(window.box.y, scene.particles.reference_radius, bins_) {}

  PairWatcher* watcher() override { return &stress_; }

  void sample(const System& system, std::size_t block) override {
    const Vector3 lengths = system.box.lengths();
    const double width = lengths.y / static_cast<double>(bins_);
    const double bin_volume = lengths.x * width * lengths.z;
    const ParticleState& particles = system.particles;
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const Vector3 place = particles.position[i];
      const Vector3 relative = particles.velocity[i] - system.box.velocity_gradient() * place;
      const double velocity = relative.x;
      variance_.add(place, relative);
      const double a = particles.radius[i];
      BlockedMean& own = of_radius_[particles.size_class[i]];
      const auto last = static_cast<std::int64_t>(std::floor((place.y + a) / width));
      for (auto k = static_cast<std::int64_t>(std::floor((place.y - a) / width)); k <= last; ++k) {
        const double below = static_cast<double>(k) * width - place.y;
        const double share = (volume_below(below + width, a) - volume_below(below, a)) / bin_volume;
        const std::size_t bin = periodic_bin(k, bins_);
        volume_fraction_.add(block, bin, share);
        flux_.add(block, bin, share * velocity);
        own.add(block, bin, share);
      }
    }
    for_each([&](auto& mean) { mean.weigh(block, 1); });
    stress_.add_step(block);
  }

  void add_to(Json& mean) const override {
    Json& profiles = mean["profiles"] = of(volume_fraction_.value(), flux_.value(), values_of(of_radius_));
    profiles["velocity_variance"] = variance_.value();
    stress_.add_to(profiles);
  }
  void add_blocks_to(Json& blocks) const override {
    if (blocks_kept(bins_) == 0) return;
    Json& profiles = blocks["profiles"] =
        of(volume_fraction_.blocks(), flux_.blocks(), blocks_of(of_radius_));
    stress_.add_blocks_to(profiles);
  }

  void save(ArchiveWriter& archive) const override {
    volume_fraction_.save(archive);
    flux_.save(archive);
    for (const BlockedMean& own : of_radius_) own.save(archive);
    stress_.save(archive);
    variance_.save(archive);
  }
  void load(ArchiveReader& archive) override {
    for_each([&](auto& mean) { mean.load(archive); });
    stress_.load(archive);
    variance_.load(archive);
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
  StressProfile stress_;
  VelocityVariance variance_;
};

// At bin centres, or at the boundaries below the bins.
Axis along_y(const Window& window, std::size_t bins, double from) {
  Axis y{"y", "length", Json::array()};
  for (std::size_t k = 0; k < bins; ++k)
    y.values.push_back((static_cast<double>(k) + from) * window.box.y / static_cast<double>(bins));
  return y;
}

void add_stress_quantities(const Scene& scene, const Axis& centres, const Axis& boundaries,
                           std::vector<Quantity>& all) {
  const Physics& physics = scene.physics;
  const char* const unit = name_of_stress_unit(physics);
  const auto add = [&](const std::string& name, const std::string& symbol, const Json& components,
                       const Axis& y) {
    all.push_back({.name = "profiles/" + name,
                   .symbol = symbol,
                   .unit = unit,
                   .axes = {{"component", "1", components}, y}});
  };
  const Json& stress = StressProfile::stress_components();
  add("stress/pairs", "σ(y)", stress, centres);
  for (const StressTerm term : StressProfile::terms(physics))
    add(std::string("stress/") + name_of(term), "σ(y)", stress, centres);
  if (!StressProfile::has_balance(physics)) return;
  const Json& flux = StressProfile::flux_components();
  add("momentum_flux", "r_y F(y)", flux, centres);
  add("drag", "f(y) dy", flux, boundaries);
  all.push_back({.name = "profiles/momentum_imbalance", .symbol = "|d flux + drag|", .unit = "largest flux"});
}

std::vector<Quantity> profile_quantities(const Scene& scene, const Window& window) {
  const std::size_t bins = bins_of(scene);
  const Axis y = along_y(window, bins, 0.5);
  const Axis radius{"radius", "length", radii_in(scene)};
  std::vector<Quantity> all = {
      {.name = "profiles/volume_fraction", .symbol = "φ(y)", .unit = "1", .axes = {y}},
      {.name = "profiles/volume_fraction_by_radius", .symbol = "φ_a(y)", .unit = "1", .axes = {radius, y}},
      {.name = "profiles/velocity",
       .symbol = "u_x(y) - U(y)",
       .unit = "length / time",
       .axes = {y},
       .ratio = RatioOfMeans{"flux", "volume_fraction"}},
      {.name = "profiles/velocity_variance",
       .symbol = "⟨(u - u*)^2⟩",
       .unit = "length^2 / time^2",
       .axes = {{"component", "1", {"x", "y", "z"}}, y}}};
  add_stress_quantities(scene, y, along_y(window, bins, 0), all);
  return all;
}

}  // namespace

ObservableKind profiles() {
  return {"profiles", seldom, [](const Scene&, const Window&, const std::string&) {}, profile_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<Profiles>(scene, system, window);
          }};
}

}  // namespace peclet::engine
