#include "engine/responses/transient.h"

#include <fmt/format.h>

#include "contract/input_error.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

struct NamedStress {
  const char *name, *symbol;
};
constexpr std::array<NamedStress, 4> stresses = {{{"shear_stress", "σ"},
                                                  {"first_normal_difference", "N_1"},
                                                  {"second_normal_difference", "N_2"},
                                                  {"pressure", "P"}}};

std::uint64_t bins_of(const Scene& scene) {
  return scene.observables.at("transient").at("bins").get<std::uint64_t>();
}

void check_bins(const Scene& scene, const Window& window, const std::string& file) {
  if (bins_of(scene) <= window.steps) return;
  throw InputError(file, "/transient/bins", std::to_string(bins_of(scene)),
                   fmt::format("must be at most {}, the steps of the production window", window.steps));
}

// Strains are those of durations: Hencky strains of extension.
std::vector<Quantity> transient_quantities(const Scene& scene, const Window& window) {
  const ImposedFlow& flow = scene.physics.flow;
  const bool is_steady = flow.steady_rate() > 0;
  const double length = window.timestep * static_cast<double>(window.steps);
  const double strain = flow.rate() * length;
  const auto bins = static_cast<double>(bins_of(scene));
  Axis axis{is_steady ? "strain" : "time", is_steady ? "1" : "time", Json::array()};
  for (double k = 0; k < bins; ++k) axis.values.push_back((k + 0.5) / bins * (is_steady ? strain : length));
  std::vector<Quantity> all;
  all.reserve(stresses.size());
  for (const auto& [name, symbol] : stresses) {
    all.push_back({.name = std::string("transient/") + name,
                   .symbol = symbol,
                   .unit = name_of_stress_unit(scene.physics),
                   .axes = {axis}});
  }
  return all;
}

}  // namespace

Transient::Transient(const Scene& scene, const System& system, const Window& window)
    : Observable(1),
      flow_(scene.physics.flow),
      has_noise_(scene.physics.thermal_energy > 0),
      viscosity_(scene.physics.viscosity),
      volume_fraction_(scene.volume_fraction),
      volume_(system.box.volume()),
      unit_(unit_of_stress(scene.physics)),
      behind_(0.5 * window.timestep),
      steps_(window.steps),
      parts_(bins_of(scene)) {}

void Transient::sample(const System& system, std::size_t /*block*/) {
  const Matrix3 gradient = flow_.deformation().velocity_gradient(system.clock.time() - behind_);
  const SymmetricTensor solvent = solvent_stress(viscosity_, gradient);
  const SymmetricTensor stress =
      (1 / unit_) * ((1 / volume_) * flux_ + solvent + stresslet(volume_fraction_, solvent));
  Part& part = parts_[taken_ * parts_.size() / steps_];
  part.sums[0] += flow_.shear_part(stress);
  part.sums[1] += stress.xx - stress.yy;
  part.sums[2] += stress.yy - stress.zz;
  part.sums[3] -= (stress.xx + stress.yy + stress.zz) / 3;
  ++part.steps;
  ++taken_;
}

void Transient::add_to(Json& mean) const {
  for (std::size_t q = 0; q < stresses.size(); ++q) {
    Json& values = mean["transient"][stresses[q].name] = Json::array();
    for (const Part& part : parts_) values.push_back(part.sums[q] / static_cast<double>(part.steps));
  }
}

void Transient::save(ArchiveWriter& archive) const {
  archive.put(taken_);
  archive.put(parts_);
}

void Transient::load(ArchiveReader& archive) {
  taken_ = archive.get<std::uint64_t>();
  parts_ = archive.get_vector<Part>(parts_.size());
}

ObservableKind transient() {
  return {"transient", every_step, check_bins, transient_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<Transient>(scene, system, window);
          }};
}

}  // namespace peclet::engine
