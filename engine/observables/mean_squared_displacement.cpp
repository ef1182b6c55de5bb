#include "engine/observables/mean_squared_displacement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace peclet::engine {
namespace {

Vector3 squares_of(const Vector3& v) { return {v.x * v.x, v.y * v.y, v.z * v.z}; }

std::vector<Vector3> unwrapped_places(const System& system) {
  std::vector<Vector3> places(system.particles.count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[system.particles.id[i]] =
        system.particles.position[i] + system.box.displacement(system.particles.image[i]);
  }
  return places;
}

// Levels of a window of so many samples. The lags 4 2^l to 7 2^l samples of the last one begin at a quarter
// of the window or before.
std::size_t levels_in(std::uint64_t samples) {
  std::size_t levels = 1;
  for (std::uint64_t reach = 2; 16 * reach <= samples; reach *= 2) ++levels;
  return levels;
}

// Lags that a completed window has met, in samples.
std::vector<std::uint64_t> lags_in(std::uint64_t samples) {
  std::vector<std::uint64_t> lags;
  for (std::size_t l = 0; l < levels_in(samples); ++l) {
    const std::uint64_t pushed = ((samples - 1) >> l) + 1;
    for (std::uint64_t k = l == 0 ? 1 : kept_places / 2; k < std::min<std::uint64_t>(kept_places, pushed);
         ++k) {
      lags.push_back(k << l);
    }
  }
  return lags;
}

std::vector<Quantity> displacement_quantities(const Scene& scene, const Window& window) {
  const std::uint64_t interval = interval_of(scene, mean_squared_displacement(), window);
  const double between = window.timestep * static_cast<double>(interval);
  Axis time{"time", "time", Json::array()};
  for (const std::uint64_t lag : lags_in(samples_in(window.steps, interval))) {
    time.values.push_back(between * static_cast<double>(lag));
  }
  std::vector<Quantity> all;
  const auto squares = [&](const std::string& group, const char* symbol) {
    for (const char* axis : {"x", "y", "z"}) {
      if (*axis == 'x' && (scene.physics.flow.rate() > 0 || scene.physics.flow.varies())) continue;
      all.push_back({.name = fmt::format("mean_squared_displacement/{}/{}", group, axis),
                     .symbol = fmt::format("⟨{}_{}^2⟩", symbol, axis),
                     .unit = "length^2",
                     .axes = {time}});
    }
  };
  squares("all", "dx");
  squares("centre", "dX");
  for (std::size_t s = 0; s < radii_in(scene).size(); ++s) squares(fmt::format("species/{}", s), "dx");
  if (scene.physics.thermal_energy > 0) {
    all.push_back({.name = "self_diffusion", .symbol = "D / D_0", .unit = "1"});
  }
  return all;
}

}  // namespace

MeanSquaredDisplacement::MeanSquaredDisplacement(const Scene& scene, const System& system,
                                                 const Window& window)
    : Observable(interval_of(scene, mean_squared_displacement(), window)),
      time_(window.timestep * static_cast<double>(interval())),
      sheared_(scene.physics.flow.rate() > 0 || scene.physics.flow.varies()),
      free_slope_(scene.physics.thermal_energy /
                  (std::numbers::pi * scene.physics.viscosity * scene.particles.reference_radius)),
      radius_of_class_(distinct_radii(system.particles.radius)),
      count_of_class_(radius_of_class_.size()),
      class_of_(system.particles.count()) {
  for (std::size_t i = 0; i < class_of_.size(); ++i) {
    class_of_[system.particles.id[i]] = system.particles.size_class[i];
    count_of_class_[system.particles.size_class[i]] += 1;
  }
  levels_.resize(levels_in(samples_in(window.steps, interval())));
  for (Level& level : levels_) level.squares.resize(kept_places * classes());
}

void MeanSquaredDisplacement::sample(const System& system, std::size_t) {
  const std::vector<Vector3> places = unwrapped_places(system);
  for (std::size_t l = 0; l < levels_.size() && samples_ % (std::uint64_t{1} << l) == 0; ++l) {
    push(levels_[l], l == 0 ? 1 : kept_places / 2, places);
  }
  ++samples_;
}

void MeanSquaredDisplacement::push(Level& level, std::size_t first_lag, const std::vector<Vector3>& places) {
  for (std::size_t k = first_lag; k < kept_places && k <= level.pushed; ++k) {
    add(level, k, level.places[(level.pushed - k) % kept_places], places);
  }
  level.places[level.pushed % kept_places] = places;
  ++level.pushed;
}

void MeanSquaredDisplacement::add(Level& level, std::size_t k, const std::vector<Vector3>& from,
                                  const std::vector<Vector3>& to) {
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

std::vector<MeanSquaredDisplacement::Lag> MeanSquaredDisplacement::lags() const {
  std::vector<Lag> lags;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    for (std::size_t k = l == 0 ? 1 : kept_places / 2; k < kept_places; ++k) {
      if (levels_[l].sums[k].origins > 0) lags.push_back({k << l, &levels_[l], k});
    }
  }
  return lags;
}

Vector3 MeanSquaredDisplacement::of_class(const Lag& lag, std::size_t size_class) const {
  const double terms = count_of_class_[size_class] * static_cast<double>(lag.level->sums[lag.k].origins);
  return (1 / terms) * lag.level->squares[lag.k * classes() + size_class];
}

Vector3 MeanSquaredDisplacement::of_all(const Lag& lag) const {
  Vector3 sum;
  for (std::size_t c = 0; c < classes(); ++c) {
    sum += (count_of_class_[c] / static_cast<double>(class_of_.size())) * of_class(lag, c);
  }
  return sum;
}

Json MeanSquaredDisplacement::axes(const std::vector<Vector3>& values) const {
  Json x = Json::array(), y = Json::array(), z = Json::array();
  for (const Vector3& value : values) {
    x.push_back(value.x);
    y.push_back(value.y);
    z.push_back(value.z);
  }
  return {{"x", sheared_ ? Json() : x}, {"y", y}, {"z", z}};
}

Json MeanSquaredDisplacement::self_diffusion(const std::vector<Lag>& lags) const {
  if (!(free_slope_ > 0)) return nullptr;
  const auto spread = [&](const Lag& lag) {
    const Sum& sum = lag.level->sums[lag.k];
    const Vector3 own = of_all(lag) - (1 / static_cast<double>(sum.origins)) * sum.centre;
    return sheared_ ? 1.5 * (own.y + own.z) : own.x + own.y + own.z;
  };
  for (auto longer = lags.rbegin(); longer != lags.rend(); ++longer) {
    for (auto shorter = longer; shorter != lags.rend(); ++shorter) {
      if (2 * shorter->samples != longer->samples) continue;
      const double time = time_ * static_cast<double>(shorter->samples);
      return (spread(*longer) - spread(*shorter)) / (time * free_slope_);
    }
  }
  return nullptr;
}

void MeanSquaredDisplacement::add_to(Json& mean) const {
  const std::vector<Lag> measured = lags();
  std::vector<Vector3> all, centre;
  Json time = Json::array(), species = Json::array();
  for (const Lag& lag : measured) {
    const Sum& sum = lag.level->sums[lag.k];
    time.push_back(time_ * static_cast<double>(lag.samples));
    all.push_back(of_all(lag));
    centre.push_back((1 / static_cast<double>(sum.origins)) * sum.centre);
  }
  for (std::size_t c = 0; c < classes(); ++c) {
    std::vector<Vector3> own;
    own.reserve(measured.size());
    for (const Lag& lag : measured) own.push_back(of_class(lag, c));
    species.push_back(axes(own));
    species.back()["radius"] = radius_of_class_[c];
  }
  mean["mean_squared_displacement"] = {
      {"time", time}, {"all", axes(all)}, {"centre", axes(centre)}, {"species", species}};
  mean["self_diffusion"] = self_diffusion(measured);
}

void MeanSquaredDisplacement::save(ArchiveWriter& archive) const {
  archive.put(samples_);
  for (const Level& level : levels_) {
    archive.put(level.pushed);
    for (std::size_t k = 0; k < kept_places && k < level.pushed; ++k) archive.put(level.places[k]);
    archive.put(level.sums);
    archive.put(level.squares);
  }
}

void MeanSquaredDisplacement::load(ArchiveReader& archive) {
  samples_ = archive.get<std::uint64_t>();
  for (Level& level : levels_) {
    level.pushed = archive.get<std::uint64_t>();
    for (std::size_t k = 0; k < kept_places && k < level.pushed; ++k) {
      level.places[k] = archive.get_vector<Vector3>(class_of_.size());
    }
    level.sums = archive.get<std::array<Sum, kept_places>>();
    level.squares = archive.get_vector<Vector3>(kept_places * classes());
  }
}

ObservableKind mean_squared_displacement() {
  return {"mean_squared_displacement", every_step,
          [](const Scene& scene, const Window& window, const std::string& file) {
            need_samples(scene, mean_squared_displacement(), window, 8, file);
          },
          displacement_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<MeanSquaredDisplacement>(scene, system, window);
          }};
}

}  // namespace peclet::engine
