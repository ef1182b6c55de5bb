// Measures profiles along y, the direction of the velocity gradient, in equal bins of the box.
//
// `volume_fraction` is the volume of spheres in a bin over that of the bin. A sphere that reaches into
// several bins gives each its slab, by its volume below the height y
//   V(y) = pi h^2 (3 a - h) / 3,   h = y - (y_i - a) between 0 and 2 a
// `volume_fraction_by_radius` has a list of bins for each radius; these add up to `volume_fraction`.
//
// `velocity` is the mean of u_x - U(y_i) with the uniform part U of the flow, weighted by each sphere's part
// V_i of the bin. It is a ratio of means: numerator sum V_i (u_x - U) and denominator sum V_i, both over the
// bin's volume. For `velocity_variance` see velocity_variance.h.
//
// Each pair's stress lies on the line between its centres (Irving & Kirkwood 1950, J. Chem. Phys. 18, 817; as
// the mean over a bin: Cormier, Rickman & Delph 2001, J. Appl. Phys. 89, 99):
//   stress_k = (1 / V_k) sum over pairs of sym(r F_i) l_k
// with the part l_k of the line within bin k. `momentum_flux` is such a sum of r_y F_i, not made symmetric:
// the traction on planes y = const, exerted on the material below. Its means over two neighbouring bins
// differ by the drag of the spheres between them,
//   flux_k - flux_(k-1) = -(1 / A) sum_i F_drag,i t(y_i) = -drag_k
// with the tent function t, 1 at the boundary and 0 a bin's width away, and A = Lx Lz. Inertia is left out:
// its mean is zero in steady flow. momentum_imbalance is the ratio of the largest |flux_k - flux_(k-1) +
// drag_k| to the largest |flux_k|.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/kernels/pair_recipes.h"
#include "engine/observables/observable.h"
#include "engine/observables/velocity_variance.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Returns the volume below the height y of a sphere of radius a around 0.
double volume_below(double y, double a) {
  const double h = std::clamp(y + a, 0.0, 2 * a);
  return std::numbers::pi * h * h * (3 * a - h) / 3;
}

// Returns the axis of the centres of bins (from = 0.5) or of the boundaries below them (from = 0).
Axis along_y(const Window& window, std::size_t bins, double from) {
  return axis_of("y", "length", bins, [&](std::size_t k) {
    return (static_cast<double>(k) + from) * window.box.y / static_cast<double>(bins);
  });
}

// Calls `visit` with each bin that the line from y to y + way crosses and the part of the line within it.
template <class Visit>
void share_line(double y, double way, double width, std::size_t bins, Visit&& visit) {
  const double low = std::min(y, y + way) / width, high = std::max(y, y + way) / width;
  const auto first = static_cast<std::int64_t>(std::floor(low));
  const auto last = std::max(first, static_cast<std::int64_t>(std::ceil(high)) - 1);
  for (std::int64_t k = first; k <= last; ++k) {
    const auto bottom = static_cast<double>(k);
    const double part =
        first == last ? 1 : (std::min(high, bottom + 1) - std::max(low, bottom)) / (high - low);
    visit(periodic_bin(k, bins), part);
  }
}

std::vector<StressTerm> terms_of(const Physics& physics) {
  std::vector<StressTerm> present;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const auto term = static_cast<StressTerm>(t);
    if (has_stress_term(physics, term)) present.push_back(term);
  }
  return present;
}

// Returns a quantity with rows of components over y.
Quantity profile(const std::string& name, const char* symbol, const Physics& physics, const Json& components,
                 const Axis& y) {
  return {.name = "profiles/" + name,
          .symbol = symbol,
          .unit = name_of_stress_unit(physics),
          .axes = {{"component", "1", components}, y}};
}
Quantity stress_profile(const std::string& name, const Physics& physics, const Axis& y) {
  return profile("stress/" + name, "σ(y)", physics, {"xx", "yy", "zz", "xy"}, y);
}
Quantity vector_profile(const char* name, const char* symbol, const Physics& physics, const Axis& y) {
  return profile(name, symbol, physics, {"xy", "yy", "zy"}, y);
}

// The stress of the pairs over y, and the balance of momentum.
class StressProfile final : public PairWatcher {
 public:
  StressProfile(Accumulators& all, const Physics& physics, const Axis& centres, const Axis& boundaries)
      : physics_(physics),
        terms_(terms_of(physics)),
        unit_(unit_of_stress(physics)),
        bins_(centres.values.size()),
        step_stress_(terms_.size() * bins_),
        step_flux_(bins_),
        step_drag_(bins_),
        stress_(all.mean(stress_profile("pairs", physics, centres))),
        flux_(all.mean_if(has_balance(), vector_profile("momentum_flux", "r_y F(y)", physics, centres))),
        drag_(all.mean_if(has_balance(), vector_profile("drag", "f(y) dy", physics, boundaries))) {
    for (const StressTerm term : terms_) {
      by_term_.push_back(&all.mean_if(true, stress_profile(name_of(term), physics, centres), 0));
    }
    if (!has_balance()) return;
    all.derive({.name = "profiles/momentum_imbalance", .symbol = "|d flux + drag|", .unit = "largest flux"},
               [this] { return imbalance(); });
  }

  void begin(const System& system, double weight) override {
    const Vector3 lengths = system.box.lengths();
    width_ = lengths.y / static_cast<double>(bins_);
    area_ = lengths.x * lengths.z;
    weight_ = weight;
    if (has_balance()) add_drag(system);
  }

  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override {
    const ParticleState& particles = system.particles;
    const Vector3 first = particles.position[pair.first];
    const Vector3 way =
        particles.position[pair.second] - first + system.box.displacement(system.list.images()[pair.image]);
    const double of_bin = weight_ / (area_ * width_);
    share_line(first.y, way.y, width_, bins_, [&](std::size_t bin, double part) {
      for (std::size_t t = 0; t < terms_.size(); ++t)
        step_stress_[t * bins_ + bin] += (part * of_bin) * sums.of(terms_[t]);
      step_flux_[bin] += (part * of_bin * way.y) * force;
    });
  }

  // A profile has the stress of pairs only, so the stress of a particle's motion is left out.
  void take_motion(const System& /*system*/, std::size_t /*particle*/,
                   const SymmetricTensor& /*stress*/) override {}

  // Ends the step whose pairs were taken.
  void add_step(std::size_t block) {
    for (std::size_t bin = 0; bin < bins_; ++bin) {
      SymmetricTensor total;
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const SymmetricTensor& own = step_stress_[t * bins_ + bin];
        add(*by_term_[t], block, bin, {own.xx, own.yy, own.zz, own.xy});
        total += own;
      }
      add(stress_, block, bin, {total.xx, total.yy, total.zz, total.xy});
      const Vector3 &flux = step_flux_[bin], &drag = step_drag_[bin];
      add(flux_, block, bin, {flux.x, flux.y, flux.z});
      add(drag_, block, bin, {drag.x, drag.y, drag.z});
    }
    for (BlockedMean* const mean : {&stress_, &flux_, &drag_}) mean->weigh(block, 1);
    for (BlockedMean* const mean : by_term_) mean->weigh(block, 1);
    std::ranges::fill(step_stress_, SymmetricTensor{});
    std::ranges::fill(step_flux_, Vector3{});
    std::ranges::fill(step_drag_, Vector3{});
  }

 private:
  // True without noise, whose forces are not part of the drag.
  bool has_balance() const { return !(physics_.thermal_energy > 0); }

  void add_drag(const System& system) {
    const ParticleState& particles = system.particles;
    const BackgroundFlow flow = physics_.flow.at(system.box);
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const double a = particles.radius[i];
      const Vector3 x = particles.position[i];
      const Vector3 drag = (weight_ * translational_drag(physics_.viscosity, a) / area_) *
                           (flow.velocity(x, a) - particles.velocity[i]);
      // Shares the drag between the boundaries below and above.
      const double place = x.y / width_, bottom = std::floor(place);
      const std::size_t below = periodic_bin(static_cast<std::int64_t>(bottom), bins_);
      step_drag_[below] += (1 - (place - bottom)) * drag;
      step_drag_[(below + 1) % bins_] += (place - bottom) * drag;
    }
  }

  void add(BlockedMean& mean, std::size_t block, std::size_t bin, std::initializer_list<double> components) {
    for (std::size_t c = 0; c < components.size(); ++c) {
      mean.add(block, c * bins_ + bin, components.begin()[c] / unit_);
    }
  }

  Json imbalance() const {
    const Json flux = flux_.value(), drag = drag_.value();
    double left = 0, largest = 0;
    for (std::size_t c = 0; c < flux.size(); ++c) {
      for (std::size_t k = 0; k < bins_; ++k) {
        const double here = flux[c][k], before = flux[c][(k + bins_ - 1) % bins_];
        left = std::max(left, std::abs(here - before + drag[c][k].get<double>()));
        largest = std::max(largest, std::abs(here));
      }
    }
    return largest > 0 ? Json(left / largest) : Json();
  }

  Physics physics_;
  std::vector<StressTerm> terms_;
  double unit_;
  std::size_t bins_;
  double width_ = 0, area_ = 0, weight_ = 0;
  // Sums of the step.
  std::vector<SymmetricTensor> step_stress_;  // rows of bins for each term
  std::vector<Vector3> step_flux_, step_drag_;
  // Means of the window.
  BlockedMean &stress_, &flux_, &drag_;
  std::vector<BlockedMean*> by_term_;
};

class Profiles : public Observable {
 public:
  Profiles(const Plan& plan, std::size_t bins)
      : Observable(plan),
        bins_(bins),
        y_(along_y(plan.window, bins, 0.5)),
        of_radius_(mean({.name = "profiles/volume_fraction_by_radius",
                         .symbol = "φ_a(y)",
                         .unit = "1",
                         .axes = {{"radius", "length", radii_in(plan.scene)}, y_}})),
        stress_(*this, plan.scene.physics, y_, along_y(plan.window, bins, 0)),
        variance_(plan.window.box.y, plan.scene.particles.reference_radius, bins) {
    derive({.name = "profiles/velocity_variance",
            .symbol = "⟨(u - u*)^2⟩",
            .unit = "length^2 / time^2",
            .axes = {{"component", "1", {"x", "y", "z"}}, y_}},
           [this] { return variance_.value(); });
    keep(variance_);
  }

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
      const std::size_t row = particles.size_class[i] * bins_;
      const auto last = static_cast<std::int64_t>(std::floor((place.y + a) / width));
      for (auto k = static_cast<std::int64_t>(std::floor((place.y - a) / width)); k <= last; ++k) {
        const double below = static_cast<double>(k) * width - place.y;
        const double share = (volume_below(below + width, a) - volume_below(below, a)) / bin_volume;
        const std::size_t bin = periodic_bin(k, bins_);
        volume_fraction_.add(block, bin, share);
        flux_.add(block, bin, share * velocity);
        of_radius_.add(block, row + bin, share);
      }
    }
    for (BlockedMean* const mean : {&volume_fraction_, &flux_, &of_radius_}) mean->weigh(block, 1);
    stress_.add_step(block);
  }

 private:
  std::size_t bins_;
  Axis y_;
  BlockedMean& volume_fraction_ =
      mean({.name = "profiles/volume_fraction", .symbol = "φ(y)", .unit = "1", .axes = {y_}});
  BlockedMean& flux_ = ratio({.name = "profiles/velocity",
                              .symbol = "u_x(y) - U(y)",
                              .unit = "length / time",
                              .axes = {y_},
                              .ratio = RatioOfMeans{"flux", "volume_fraction"}},
                             volume_fraction_);
  BlockedMean& of_radius_;
  StressProfile stress_;
  VelocityVariance variance_;
};

}  // namespace

ObservableKind profiles() {
  return {.name = "profiles",
          .meaning =
              "over y: volume fraction, also of each radius, velocity and its variance, stress by term, "
              "and the balance of momentum",
          .settings = "/profiles/bins | integer >= 1 and <= 1000; default 20 | Number of equal bins along y.",
          .read = [](const SceneDocument& document, const Scene&) {
            return maker<Profiles>(document.at("/profiles/bins").get<std::size_t>());
          }};
}

}  // namespace peclet::engine
