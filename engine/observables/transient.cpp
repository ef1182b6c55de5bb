// Measures the stress over the strain of the production window, for a flow that begins, is reversed or stops.
// If the rate is not constant and positive, it is over time.
//
// Each of a number of equal parts of the window has its own mean, without blocks. The stress is the flux of
// momentum that acted in each step (kernels/pair_pass.h), with the parts of solvent and stresslets. Its unit
// is viscosity times rate if that is constant, so that shear_stress is the relative viscosity.
//
// With a gap, `fabric` has the tensors of fabric.h in the same parts, with at least three samples in each.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "contract/errors.h"
#include "engine/observables/fabric.h"
#include "engine/observables/observable.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

constexpr std::pair<const char*, const char*> stresses[] = {{"shear_stress", "σ"},
                                                            {"first_normal_difference", "N_1"},
                                                            {"second_normal_difference", "N_2"},
                                                            {"pressure", "P"}};

// Returns the axis of the middles of equal parts. Strains are those of durations: Hencky strains in
// extension.
Axis parts_of(const Window& window, const ImposedFlow& flow, std::size_t parts) {
  const bool is_steady = flow.steady_rate() > 0;
  const double length = window.timestep * static_cast<double>(window.steps);
  const double whole = is_steady ? flow.rate() * length : length;
  return axis_of(is_steady ? "strain" : "time", is_steady ? "1" : "time", parts, [&](std::size_t k) {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(parts) * whole;
  });
}

// Returns the steps between samples of the fabric, which changes slowly.
std::uint64_t fabric_interval(std::uint64_t steps, std::size_t parts) {
  return std::max<std::uint64_t>(1, steps / std::max<std::size_t>(256, 4 * parts));
}

class Transient : public Observable {
 public:
  // `gap` is that of near pairs; without it the fabric is not measured.
  Transient(const Plan& plan, std::size_t bins, std::optional<double> gap)
      : Observable(plan),
        flow_(plan.scene.physics.flow),
        has_noise_(plan.scene.physics.thermal_energy > 0),
        viscosity_(plan.scene.physics.viscosity),
        volume_fraction_(plan.scene.volume_fraction),
        volume_(PeriodicCell::with_edges(flow_.deformation().edges_at_start(plan.window.box), {}).volume()),
        unit_(unit_of_stress(plan.scene.physics)),
        behind_(0.5 * plan.window.timestep),
        steps_(plan.window.steps),
        gap_(gap),
        interval_of_fabric_(fabric_interval(steps_, bins)),
        parts_(bins) {
    if (bins > steps_) {
      throw InputError(
          plan.file, "/transient/bins", std::to_string(bins),
          fmt::format("must be at most {}, the number of steps of the production window", steps_));
    }
    const Axis axis = parts_of(plan.window, flow_, bins);
    for (std::size_t q = 0; q < std::size(stresses); ++q) {
      derive({.name = std::string("transient/") + stresses[q].first,
              .symbol = stresses[q].second,
              .unit = name_of_stress_unit(plan.scene.physics),
              .axes = {axis}},
             [this, q] { return means_of(q); });
    }
    if (gap_) {
      if (plan.scene.physics.contact) register_fabric("contacts", axis, &FabricSums::contacts);
      register_fabric("near", axis, &FabricSums::near);
    }
    keep(taken_, parts_);
  }

  bool takes_flux() const override { return true; }
  void take_flux(const MomentumFlux& flux) override { flux_ = stress_of(flux, has_noise_); }

  void sample(const System& system, std::size_t /*block*/) override {
    const Matrix3 gradient = flow_.deformation().velocity_gradient(system.clock.time() - behind_);
    const SymmetricTensor solvent = solvent_stress(viscosity_, gradient);
    const SymmetricTensor stress =
        (1 / unit_) * ((1 / volume_) * flux_ + solvent + stresslet(volume_fraction_, solvent));
    Part& part = parts_[taken_ * parts_.size() / steps_];
    part.sums[0] += flow_.shear_part(stress);
    part.sums[1] += stress.xx - stress.yy;
    part.sums[2] += stress.yy - stress.zz;
    part.sums[3] -= (stress.xx + stress.yy + stress.zz) / 3;
    if (gap_ && taken_ % interval_of_fabric_ == 0) {
      const FabricSums sums = fabric_of(system, *gap_);
      part.fabric.contacts += sums.contacts;
      part.fabric.near += sums.near;
    }
    ++part.steps;
    ++taken_;
  }

 private:
  struct Part {
    std::array<double, std::size(stresses)> sums{};
    std::uint64_t steps = 0;
    FabricSums fabric;
  };

  void register_fabric(const std::string& which, const Axis& axis, FabricSums::Pairs FabricSums::*pairs) {
    derive(fabric_quantity("transient/fabric/" + which, {axis}), [=, this] {
      Json rows(axis_of_components().values.size(), Json::array());
      for (const Part& part : parts_) {
        const FabricSums::Pairs& found = part.fabric.*pairs;
        const std::vector<double> sums = components_of(found.sum);
        for (std::size_t c = 0; c < sums.size(); ++c) {
          rows[c].push_back(found.count > 0 ? Json(sums[c] / found.count) : Json());
        }
      }
      return rows;
    });
  }

  Json means_of(std::size_t stress) const {
    Json values = Json::array();
    for (const Part& part : parts_) values.push_back(part.sums[stress] / static_cast<double>(part.steps));
    return values;
  }

  ImposedFlow flow_;
  bool has_noise_;
  double viscosity_, volume_fraction_, volume_, unit_;
  double behind_;  // half a step: the time from its middle, where the rate is the step's mean, to its end
  std::uint64_t steps_, taken_ = 0;
  SymmetricTensor flux_;
  std::optional<double> gap_;
  std::uint64_t interval_of_fabric_;
  std::vector<Part> parts_;
};

}  // namespace

ObservableKind transient() {
  return {.name = "transient",
          .meaning =
              "shear stress, normal stress differences and pressure over the strain, or time, of the "
              "window",
          .sampling = Sampling::of_every_step,
          .settings = R"(
/transient/bins | integer >= 1 and <= 1000; default 50 | Number of equal parts of the production window.
/transient/fabric_gap? | number > 0 and <= 1 | As /fabric/gap, for the fabric in these parts; absent: the
    fabric is not measured.
)",
          .read = [](const SceneDocument& document, const Scene& scene) {
            require_stress_of_forces(document, scene, "transient");
            std::optional<double> gap;
            if (document.has("/transient/fabric_gap")) gap = document.number("/transient/fabric_gap");
            return maker<Transient>(document.at("/transient/bins").get<std::size_t>(), gap);
          }};
}

}  // namespace peclet::engine
