// Measures mean squared displacements over lags from one sample to seven sixteenths of the window:
//
//   x(t) = < (x_i(s + t) - x_i(s))^2 >, y and z likewise
//
// with the mean over particles i of a species (or all) and origins s, of unwrapped positions in the
// laboratory frame [length^2]. `centre` has the squares of the mean displacement of all particles: the motion
// of the suspension as a whole, which is not diffusion. In shear the flow carries particles along x, and x is
// left out.
//
// Lags are k 2^l samples: k = 1 ... 7 for l = 0 and 4 ... 7 beyond, with origins 2^l samples apart, so that
// the cost per sample does not grow with the window. Memory: 192 bytes for each particle and level.
//
// self_diffusion is the slope between lags of a tenth and a fifth of the window, the same for every step, in
// three dimensions, relative to the centre, over that of a free sphere of the reference radius a
//   D_0 = kT / (pi eta a)   (Li's thesis, ch. 4; three times the one-dimensional kT / (3 pi eta a))
// It is null without temperature. In shear it is 3/2 of the slope of y and z.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "engine/observables/observable.h"

namespace peclet::engine {
namespace {

constexpr std::size_t kept_places = 8;       // in each level
constexpr std::uint64_t least_samples = 10;  // a tenth of the window is at least the shortest lag
constexpr const char* diffusion_name = "self_diffusion";

Vector3 squares_of(const Vector3& v) { return {v.x * v.x, v.y * v.y, v.z * v.z}; }

std::vector<Vector3> unwrapped_places(const System& system) {
  std::vector<Vector3> places(system.particles.count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[system.particles.id[i]] =
        system.particles.position[i] + system.box.displacement(system.particles.image[i]);
  }
  return places;
}

// Returns the number of levels, such that the shortest lag of the last is at most a quarter of the window.
std::size_t levels_in(std::uint64_t samples) {
  std::size_t levels = 1;
  for (std::uint64_t reach = 2; 16 * reach <= samples; reach *= 2) ++levels;
  return levels;
}

class MeanSquaredDisplacement : public Observable {
 public:
  explicit MeanSquaredDisplacement(const Plan& plan)
      : Observable(plan),
        time_(plan.time_between()),
        sheared_(plan.scene.physics.flow.rate() > 0 || plan.scene.physics.flow.varies()),
        free_slope_(plan.scene.physics.thermal_energy / (std::numbers::pi * plan.scene.physics.viscosity *
                                                         plan.scene.particles.reference_radius)) {
    plan.need_samples("mean_squared_displacement", least_samples);
    const std::vector<double> radii = radii_in(plan.scene);
    set_classes(plan.scene.particles, radii);
    levels_.resize(levels_in(plan.samples()), Level(class_of_.size(), radii.size()));
    keep(samples_, levels_);
    register_squares(radii, plan.samples());
    if (!(free_slope_ > 0)) {
      beside(diffusion_name, nullptr);
    } else {
      derive({.name = diffusion_name, .symbol = "D / D_0", .unit = "1"}, [this] { return self_diffusion(); });
    }
  }

  void sample(const System& system, std::size_t) override {
    const std::vector<Vector3> places = unwrapped_places(system);
    for (std::size_t l = 0; l < levels_.size() && samples_ % (std::uint64_t{1} << l) == 0; ++l) {
      push(levels_[l], first_lag_of(l), places);
    }
    ++samples_;
  }

 private:
  struct Sum {  // over origins, of one lag
    std::uint64_t origins = 0;
    Vector3 centre;  // squares of the mean displacement
  };
  struct Level {
    Level(std::size_t count, std::size_t classes) : particles(count), squares(kept_places * classes) {}

    std::size_t particles;
    std::uint64_t pushed = 0;
    std::array<std::vector<Vector3>, kept_places> places;  // by id; a ring
    std::array<Sum, kept_places> sums{};                   // by k
    std::vector<Vector3> squares;  // by k and size class: sums over particles and origins

    void save(ArchiveWriter& archive) const {
      archive.put_all(pushed, sums, squares);
      for (std::size_t k = 0; k < kept_places && k < pushed; ++k) archive.put(places[k]);
    }
    void load(ArchiveReader& archive) {
      archive.get_all(pushed, sums, squares);
      for (std::size_t k = 0; k < kept_places && k < pushed; ++k) {
        places[k] = archive.get_vector<Vector3>(particles);
      }
    }
  };
  // A point of the curves.
  struct Lag {
    std::uint64_t samples;
    const Level* level;
    std::size_t k;
  };

  static std::size_t first_lag_of(std::size_t level) { return level == 0 ? 1 : kept_places / 2; }
  std::size_t classes() const { return count_of_class_.size(); }

  // Ids count the spheres species by species.
  void set_classes(const Particles& particles, const std::vector<double>& radii) {
    count_of_class_.resize(radii.size());
    const std::vector<std::size_t> number = species_numbers(particles);
    for (std::size_t s = 0; s < number.size(); ++s) {
      const auto place = std::ranges::lower_bound(radii, particles.species[s].radius) - radii.begin();
      class_of_.insert(class_of_.end(), number[s], static_cast<std::uint16_t>(place));
      count_of_class_[static_cast<std::size_t>(place)] += static_cast<double>(number[s]);
    }
  }

  // Registers curves over the lags that a completed window has.
  void register_squares(const std::vector<double>& radii, std::uint64_t samples) {
    std::vector<std::uint64_t> lags;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      const std::uint64_t pushed = ((samples - 1) >> l) + 1;
      for (std::size_t k = first_lag_of(l); k < std::min<std::uint64_t>(kept_places, pushed); ++k) {
        lags.push_back(k << l);
      }
    }
    const Axis time = axis_of_lags("time", lags, time_);
    beside("mean_squared_displacement/time", time.values);
    register_axes("all", "dx", time, [this](const Lag& lag) { return of_all(lag); });
    register_axes("centre", "dX", time, [this](const Lag& lag) { return of_centre(lag); });
    for (std::size_t c = 0; c < classes(); ++c) {
      const std::string group = fmt::format("species/{}", c);
      register_axes(group, "dx", time, [=, this](const Lag& lag) { return of_class(lag, c); });
      beside(fmt::format("mean_squared_displacement/{}/radius", group), radii[c]);
    }
  }

  void register_axes(const std::string& group, const char* symbol, const Axis& time,
                     const std::function<Vector3(const Lag&)>& squares) {
    constexpr std::pair<const char*, double Vector3::*> all[] = {
        {"x", &Vector3::x}, {"y", &Vector3::y}, {"z", &Vector3::z}};
    for (const auto& [axis, component] : all) {
      const std::string name = fmt::format("mean_squared_displacement/{}/{}", group, axis);
      if (sheared_ && component == &Vector3::x) {
        beside(name, nullptr);
        continue;
      }
      derive({.name = name,
              .symbol = fmt::format("⟨{}_{}^2⟩", symbol, axis),
              .unit = "length^2",
              .axes = {time}},
             [=, this, component = component] {
               Json values = Json::array();
               for (const Lag& lag : lags()) values.push_back(squares(lag).*component);
               return values;
             });
    }
  }

  void push(Level& level, std::size_t first, const std::vector<Vector3>& places) {
    for (std::size_t k = first; k < kept_places && k <= level.pushed; ++k) {
      add(level, k, level.places[(level.pushed - k) % kept_places], places);
    }
    level.places[level.pushed % kept_places] = places;
    ++level.pushed;
  }

  void add(Level& level, std::size_t k, const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
    Vector3* const squares = &level.squares[k * classes()];
    Vector3 sum;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Vector3 way = to[i] - from[i];
      sum += way;
      squares[class_of_[i]] += squares_of(way);
    }
    level.sums[k].centre += squares_of((1 / static_cast<double>(from.size())) * sum);
    ++level.sums[k].origins;
  }

  std::vector<Lag> lags() const {
    std::vector<Lag> lags;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      for (std::size_t k = first_lag_of(l); k < kept_places; ++k) {
        if (levels_[l].sums[k].origins > 0) lags.push_back({k << l, &levels_[l], k});
      }
    }
    return lags;
  }

  Vector3 of_centre(const Lag& lag) const {
    const Sum& sum = lag.level->sums[lag.k];
    return (1 / static_cast<double>(sum.origins)) * sum.centre;
  }

  Vector3 of_class(const Lag& lag, std::size_t size_class) const {
    const double terms = count_of_class_[size_class] * static_cast<double>(lag.level->sums[lag.k].origins);
    return (1 / terms) * lag.level->squares[lag.k * classes() + size_class];
  }

  Vector3 of_all(const Lag& lag) const {
    Vector3 sum;
    for (std::size_t c = 0; c < classes(); ++c) {
      sum += (count_of_class_[c] / static_cast<double>(class_of_.size())) * of_class(lag, c);
    }
    return sum;
  }

  Json self_diffusion() const {
    if (samples_ < least_samples) return nullptr;
    const double lag = 0.1 * static_cast<double>(samples_);
    return (spread_after(2 * lag) - spread_after(lag)) / (time_ * lag * free_slope_);
  }

  // Returns |Δr|² about the centre after a lag [samples]: a power of the lag between two lags of the curves.
  double spread_after(double samples) const {
    const std::vector<Lag> all = lags();
    const auto at = [](const Lag& lag) { return static_cast<double>(lag.samples); };
    const auto longer = std::ranges::lower_bound(all, samples, {}, at);
    const auto shorter = longer == all.begin() ? longer : std::prev(longer);
    const double part =
        longer == shorter ? 0 : std::log(samples / at(*shorter)) / std::log(at(*longer) / at(*shorter));
    return std::pow(spread(*shorter), 1 - part) * std::pow(spread(*longer), part);
  }

  double spread(const Lag& lag) const {
    const Vector3 own = of_all(lag) - of_centre(lag);
    // Rounding may leave less than nothing of spheres that move together.
    return std::max(sheared_ ? 1.5 * (own.y + own.z) : own.x + own.y + own.z, 0.0);
  }

  double time_;  // between samples
  bool sheared_;
  double free_slope_;  // D_0; 0 without temperature
  std::vector<double> count_of_class_;
  std::vector<std::uint16_t> class_of_;  // by id
  std::uint64_t samples_ = 0;
  std::vector<Level> levels_;
};

}  // namespace

ObservableKind mean_squared_displacement() {
  return {.name = "mean_squared_displacement",
          .meaning = "of each species and of all particles, over lags; self-diffusion",
          .sampling = Sampling::often,
          .numbers = {diffusion_name},
          .read = [](const SceneDocument&, const Scene&) { return maker<MeanSquaredDisplacement>(); }};
}

}  // namespace peclet::engine
