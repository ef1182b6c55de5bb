#include "engine/realisation/stress_means.h"

#include <algorithm>
#include <span>

#include "engine/flow/controlled_shear.h"
#include "engine/integrators/derived_groups.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

constexpr std::size_t xy = 3;

}  // namespace

StressMeans::StressMeans(const Scene& scene) : physics_(scene.physics), unit_(unit_of_stress(physics_)) {
  add_background();
  const auto per_step = [unit = unit_](const Measured& of) {
    return 1 / (static_cast<double>(of.sums.steps) * of.volume * unit);
  };
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const auto term = static_cast<StressTerm>(t);
    if (!has_stress_term(physics_, term)) continue;
    std::string words = name_of(term);
    std::ranges::replace(words, '_', ' ');
    parts_.push_back({name_of(term), "σ^{" + words + '}',
                      [=](const Measured& of) { return per_step(of) * of.sums.stress[t]; }});
  }
  // The stress that the motion of the particles carries, -sum m sym(v v) / V.
  if (physics_.thermal_energy > 0) {
    parts_.push_back(
        {"motion", "σ^motion", [=](const Measured& of) { return per_step(of) * of.sums.motion; }});
  }
  others_.push_back(
      {tensor("stress/total", "σ"), [](const Measured& of) { return components_of(of.total); }});
  others_.push_back({tensor("brownian_structural", "σ^B"), [unit = unit_](const Measured& of) {
                       const double per_sample = 1 / static_cast<double>(of.sums.samples);
                       return components_of((per_sample / unit) * of.sums.structural_brownian);
                     }});
  add_scalars();
  if (const ControlledShear* const flow = physics_.flow.deformation().at_stress()) {
    add_flow(flow->stress(), notices_jams(scene));
  }
}

Quantity StressMeans::tensor(const std::string& name, const std::string& symbol) const {
  return {
      .name = name, .symbol = symbol, .unit = name_of_stress_unit(physics_), .axes = {axis_of_components()}};
}

// Adds the stress of the solvent, and the stresslets of isolated spheres.
void StressMeans::add_background() {
  const bool is_steady = physics_.flow.steady_rate() > 0, varies = physics_.flow.varies();
  const bool has_solvent = is_steady || physics_.flow.deformation().at_stress() != nullptr;
  const auto solvent = [=, this](const Measured& of) {
    if (is_steady) return 2.0 * physics_.flow.direction();  // in units of itself
    const double rate = of.sums.shear_rate / static_cast<double>(of.sums.steps);
    return solvent_stress(physics_.viscosity, simple_shear(rate));
  };
  const auto varying = [this](const Measured& of) {
    return (1 / (static_cast<double>(of.sums.samples) * unit_)) * of.sums.varying_stresslet;
  };
  const auto stresslets = [=](const Measured& of) {
    if (!has_solvent) return varying(of);
    const SymmetricTensor uniform = stresslet(of.volume_fraction, solvent(of));
    return is_steady ? uniform + varying(of) : uniform;
  };
  if (has_solvent) parts_.push_back({"solvent", "σ^S", solvent, true, false});
  if (has_solvent || varies) parts_.push_back({"stresslet", "σ^E", stresslets, !varies, false});
}

void StressMeans::add_scalars() {
  const bool is_sheared = physics_.flow.steady_rate() > 0;
  const char* const unit = name_of_stress_unit(physics_);
  const auto add = [&](const char* name, const char* symbol, const char* of_unit, auto value) {
    others_.push_back({{.name = name, .symbol = symbol, .unit = of_unit}, value});
  };
  const auto viscosity = [&](const char* name, const char* symbol, SymmetricTensor Measured::*stress) {
    add(name, symbol, "1", [=, this](const Measured& of) {
      return is_sheared ? Json(physics_.flow.shear_part(of.*stress)) : Json();
    });
    others_.back().is_described = is_sheared;
  };
  viscosity("relative_viscosity", "η_r", &Measured::total);
  viscosity("relative_viscosity_pair", "η_r^pairs", &Measured::pairs);
  add("first_normal_difference", "N_1", unit, [](const Measured& of) { return of.total.xx - of.total.yy; });
  add("second_normal_difference", "N_2", unit, [](const Measured& of) { return of.total.yy - of.total.zz; });
  add("pressure", "P", unit,
      [](const Measured& of) { return -(of.total.xx + of.total.yy + of.total.zz) / 3; });
  add("contacts_per_particle", "Z", "1", [](const Measured& of) {
    return 2 * of.sums.contacts / (static_cast<double>(of.sums.steps) * of.particles);
  });
  add("mean_overlap", "⟨δ/a⟩", "1", [](const Measured& of) { return of.sums.mean_overlap(); });
  const auto per_sample = [](const Measured& of) { return 1 / static_cast<double>(of.sums.samples); };
  add("kinetic_temperature", "k_B T", "energy",
      [=](const Measured& of) { return per_sample(of) * of.sums.temperature.translational; });
  add("rotational_temperature", "k_B T_rot", "energy",
      [=](const Measured& of) { return per_sample(of) * of.sums.temperature.rotational; });
}

// Adds the quantities of a flow at a given stress. The rate of a jammed suspension is 0, even if it strained
// before. The mean of `flowing` over seeds is the share that flows to the end; it is null if the window is
// too short to detect a jam. Over seeds a viscosity is stress over mean rate.
void StressMeans::add_flow(double stress, bool notices_jams) {
  const auto rate = [](const Measured& of) {
    return of.has_jammed ? 0 : of.sums.shear_rate / static_cast<double>(of.sums.planned);
  };
  const auto flows = [](const Measured& of) {
    return !of.has_jammed && of.sums.steps == of.sums.planned ? 1.0 : 0.0;
  };
  const auto known = [=](double number) { return notices_jams ? Json(number) : Json(); };
  others_.push_back({{.name = "shear_rate", .symbol = "⟨γ̇⟩", .unit = "1 / time"}, rate});
  others_.push_back({{.name = "flowing", .symbol = "P(flows)", .unit = "1", .is_share = true},
                     [=](const Measured& of) { return known(flows(of)); }});
  const auto viscosity = [&](const char* name, const char* symbol, auto value) {
    others_.push_back(
        {{.name = name, .symbol = symbol, .unit = "1", .ratio = {{"stress", "viscous_stress"}}}, value});
  };
  viscosity("apparent_viscosity", "η_r", [=, this](const Measured& of) {
    return Json{{"stress", stress}, {"viscous_stress", physics_.viscosity * rate(of)}};
  });
  viscosity("viscosity_of_those_flowing", "η_r^flowing", [=, this](const Measured& of) {
    return Json{{"stress", known(flows(of) * stress)},
                {"viscous_stress", known(flows(of) * (physics_.viscosity * rate(of)))}};
  });
}

std::vector<Quantity> StressMeans::quantities() const {
  std::vector<Quantity> all;
  for (const Part& part : parts_) all.push_back(tensor("stress/" + part.name, part.symbol));
  for (const Named& other : others_) {
    if (other.is_described) all.push_back(other.quantity);
  }
  return all;
}

Json StressMeans::means(const System& system, const BlockSums& sums, bool has_jammed) const {
  const double volume = system.box.volume();
  Measured measured{sums, volume, solid_volume(system.particles) / volume,
                    static_cast<double>(system.particles.count()), has_jammed};
  Json means = Json::object();
  for (const Part& part : parts_) {
    const SymmetricTensor mean = part.mean(measured);
    means["stress"][part.name] = components_of(mean);
    measured.total += mean;
    if (part.is_of_pairs) measured.pairs += mean;
  }
  for (const Named& other : others_) {
    means[Json::json_pointer('/' + other.quantity.name)] = other.value(measured);
  }
  return means;
}

Json StressMeans::blocks(const System& system, const Production& production) const {
  const std::span<const BlockSums> all = production.blocks();
  Json kept;
  for (const BlockSums& block : all) {
    const Json mean = means(system, block);
    for (const auto& [name, value] : mean.items()) {
      if (!value.is_structured()) kept[name].push_back(rounded(value));
    }
    // The total is left out: its xy is the relative viscosity.
    Json& shear = kept["shear_stress"];
    for (const Part& part : parts_) {
      if (!part.is_constant) shear[part.name].push_back(rounded(mean["stress"][part.name][xy]));
    }
    shear["brownian_structural"].push_back(rounded(mean["brownian_structural"][xy]));
  }
  constexpr std::size_t in_a_quarter = count_of_blocks / count_of_quarters;
  for (std::size_t quarter = 0; quarter < count_of_quarters; ++quarter) {
    const Json mean = means(system, sum_of(all.subspan(quarter * in_a_quarter, in_a_quarter)));
    for (const Part& part : parts_) {
      if (!part.is_constant) kept["stress"][part.name].push_back(rounded(mean["stress"][part.name]));
    }
    kept["stress"]["total"].push_back(rounded(mean["stress"]["total"]));
    kept["brownian_structural"].push_back(rounded(mean["brownian_structural"]));
  }
  return kept;
}

}  // namespace peclet::engine
