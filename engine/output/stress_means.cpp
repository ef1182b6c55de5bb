#include "engine/output/stress_means.h"

#include <algorithm>
#include <span>
#include <string>

#include "engine/stability/derived_groups.h"
#include "engine/start/packing.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

Json to_json(const SymmetricTensor& t) { return {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}; }

double first_normal_difference(const SymmetricTensor& t) { return t.xx - t.yy; }
double second_normal_difference(const SymmetricTensor& t) { return t.yy - t.zz; }
double pressure(const SymmetricTensor& t) { return -(t.xx + t.yy + t.zz) / 3; }

// The part of the stress that the motion of the particles carries, -sum m sym(v v) / V.
constexpr const char* stress_of_motion_name = "motion";

// Terms of the stress that are the same in every configuration.
bool is_constant(const std::string& term, bool flow_varies) {
  return term == "solvent" || (term == "stresslet" && !flow_varies);
}

// What is kept of each of the 32 blocks. The total's xy is the relative viscosity.
Json of_block(const Json& means, bool flow_varies) {
  Json kept;
  for (const auto& [name, value] : means.items()) {
    if (!value.is_structured()) kept[name] = rounded(value);
  }
  for (const auto& [term, stress] : means.at("stress").items()) {
    if (!is_constant(term, flow_varies) && term != "total")
      kept["shear_stress"][term] = rounded(stress.at(3));
  }
  kept["shear_stress"]["brownian_structural"] = rounded(means.at("brownian_structural").at(3));
  return kept;
}

// What is kept of each quarter of the window.
Json of_quarter(const Json& means, bool flow_varies) {
  Json kept;
  for (const auto& [term, stress] : means.at("stress").items()) {
    if (!is_constant(term, flow_varies)) kept["stress"][term] = rounded(stress);
  }
  kept["brownian_structural"] = rounded(means.at("brownian_structural"));
  return kept;
}

// Turns a list of equal objects into one object of lists.
Json transposed(const std::vector<Json>& rows) {
  if (!rows.front().is_object()) {
    return rows;
  }
  Json columns = Json::object();
  for (const auto& [name, value] : rows.front().items()) {
    std::vector<Json> column;
    column.reserve(rows.size());
    for (const Json& row : rows) {
      column.push_back(row.at(name));
    }
    columns[name] = transposed(column);
  }
  return columns;
}

// Descriptions of the stress and its parts.
class Described {
 public:
  explicit Described(const Scene& scene) : unit_(name_of_stress_unit(scene.physics)) {}

  void scalar(const char* name, const char* symbol, const char* unit) {
    all_.push_back({.name = name, .symbol = symbol, .unit = unit});
  }
  void stress(const std::string& name, const std::string& symbol) {
    all_.push_back({.name = name,
                    .symbol = symbol,
                    .unit = unit_,
                    .axes = {{"component", "1", {"xx", "yy", "zz", "xy", "xz", "yz"}}}});
  }
  // A given stress over the mean of another one.
  void viscosity(const char* name, const char* symbol) {
    all_.push_back({.name = name, .symbol = symbol, .unit = "1", .ratio = {{"stress", "viscous_stress"}}});
  }
  // The last one is 0 or 1.
  void as_share() { all_.back().is_share = true; }

  const char* unit() const { return unit_; }
  std::vector<Quantity> take() { return std::move(all_); }

 private:
  const char* unit_;
  std::vector<Quantity> all_;
};

}  // namespace

StressMeans::StressMeans(const Scene& scene, const System& system)
    : physics_(scene.physics),
      volume_(system.box.volume()),
      volume_fraction_(solid_volume(system.particles) / volume_),
      particles_(static_cast<double>(system.particles.count())),
      unit_(unit_of_stress(physics_)),
      notices_jams_(notices_jams(scene)) {}

Json StressMeans::means(const BlockSums& sums, bool has_jammed) const {
  Json stress = Json::object();
  SymmetricTensor total;
  const auto part = [&](const char* name, const SymmetricTensor& value) {
    stress[name] = to_json(value);
    total += value;
  };
  const SymmetricTensor varying = (1 / (static_cast<double>(sums.samples) * unit_)) * sums.varying_stresslet;
  if (physics_.flow.steady_rate() > 0) {
    const SymmetricTensor solvent = 2.0 * physics_.flow.direction();  // in units of itself
    part("solvent", solvent);
    part("stresslet", stresslet(volume_fraction_, solvent) + varying);
  } else if (physics_.flow.varies()) {
    part("stresslet", varying);
  } else if (physics_.flow.deformation().stress()) {
    const double rate = sums.shear_rate / static_cast<double>(sums.steps);
    const SymmetricTensor solvent = solvent_stress(physics_.viscosity, simple_shear(rate));
    part("solvent", solvent);
    part("stresslet", stresslet(volume_fraction_, solvent));
  }
  const double per_step = 1 / (static_cast<double>(sums.steps) * volume_ * unit_);
  SymmetricTensor pairs;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const auto term = static_cast<StressTerm>(t);
    if (!has_stress_term(physics_, term)) continue;
    const SymmetricTensor mean = per_step * sums.stress[t];
    part(name_of(term), mean);
    pairs += mean;
  }
  if (physics_.thermal_energy > 0) {
    part(stress_of_motion_name, per_step * sums.motion);
    pairs += per_step * sums.motion;
  }
  stress["total"] = to_json(total);
  const bool sheared = physics_.flow.steady_rate() > 0;
  const double per_sample = 1 / static_cast<double>(sums.samples);
  Json means = {{"stress", stress},
                {"brownian_structural", to_json((per_sample / unit_) * sums.structural_brownian)},
                {"relative_viscosity", sheared ? Json(physics_.flow.shear_part(total)) : Json()},
                {"relative_viscosity_pair", sheared ? Json(physics_.flow.shear_part(pairs)) : Json()},
                {"first_normal_difference", first_normal_difference(total)},
                {"second_normal_difference", second_normal_difference(total)},
                {"pressure", pressure(total)},
                {"contacts_per_particle", 2 * sums.contacts / (static_cast<double>(sums.steps) * particles_)},
                {"mean_overlap", sums.mean_overlap()},
                {"kinetic_temperature", per_sample * sums.temperature.translational},
                {"rotational_temperature", per_sample * sums.temperature.rotational}};
  if (const std::optional<double> given = physics_.flow.deformation().stress()) {
    add_flow(sums, *given, has_jammed, means);
  }
  return means;
}

// What has jammed stands still in the long run: its rate is 0, however far it strained before. Over the seeds
// the mean of `flowing` is the share that flows to the end, which nothing tells in a window that is too short
// to notice a jam. Viscosities are stress over mean rate, never a mean of stress over rate.
void StressMeans::add_flow(const BlockSums& sums, double stress, bool has_jammed, Json& means) const {
  const double rate = has_jammed ? 0 : sums.shear_rate / static_cast<double>(sums.planned);
  const double viscous = physics_.viscosity * rate;
  const double flows = !has_jammed && sums.steps == sums.planned ? 1 : 0;
  const auto known = [&](double number) { return notices_jams_ ? Json(number) : Json(); };
  means["shear_rate"] = rate;
  means["flowing"] = known(flows);
  means["apparent_viscosity"] = {{"stress", stress}, {"viscous_stress", viscous}};
  means["viscosity_of_those_flowing"] = {{"stress", known(flows * stress)},
                                         {"viscous_stress", known(flows * viscous)}};
}

Json StressMeans::blocks(const Production& production) const {
  const std::span<const BlockSums> all = production.blocks();
  const bool varies = physics_.flow.varies();
  std::vector<Json> blocks, quarters;
  for (const BlockSums& block : all) blocks.push_back(of_block(means(block), varies));
  constexpr std::size_t in_a_quarter = count_of_blocks / count_of_quarters;
  for (std::size_t quarter = 0; quarter < count_of_quarters; ++quarter) {
    const BlockSums sums = sum_of(all.subspan(quarter * in_a_quarter, in_a_quarter));
    quarters.push_back(of_quarter(means(sums), varies));
  }
  Json kept = transposed(blocks);
  kept.update(transposed(quarters));
  return kept;
}

std::vector<Quantity> stress_quantities(const Scene& scene) {
  const bool sheared = scene.physics.flow.steady_rate() > 0;
  Described described(scene);
  const char* const unit = described.unit();
  if (sheared) {
    described.scalar("relative_viscosity", "η_r", "1");
    described.scalar("relative_viscosity_pair", "η_r^pairs", "1");
    described.stress("stress/solvent", "σ^S");
  }
  const bool at_stress = scene.physics.flow.deformation().stress().has_value();
  if (at_stress) {
    described.scalar("shear_rate", "⟨γ̇⟩", "1 / time");
    described.scalar("flowing", "P(flows)", "1");
    described.as_share();
    described.viscosity("apparent_viscosity", "η_r");
    described.viscosity("viscosity_of_those_flowing", "η_r^flowing");
    described.stress("stress/solvent", "σ^S");
  }
  if (sheared || at_stress || scene.physics.flow.varies()) described.stress("stress/stresslet", "σ^E");
  described.scalar("first_normal_difference", "N_1", unit);
  described.scalar("second_normal_difference", "N_2", unit);
  described.scalar("pressure", "P", unit);
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const auto term = static_cast<StressTerm>(t);
    if (!has_stress_term(scene.physics, term)) continue;
    std::string words = name_of(term);
    std::replace(words.begin(), words.end(), '_', ' ');
    described.stress(std::string("stress/") + name_of(term), "σ^{" + words + '}');
  }
  if (scene.physics.thermal_energy > 0) {
    described.stress(std::string("stress/") + stress_of_motion_name, "σ^motion");
  }
  described.stress("stress/total", "σ");
  described.stress("brownian_structural", "σ^B");
  described.scalar("contacts_per_particle", "Z", "1");
  described.scalar("mean_overlap", "⟨δ/a⟩", "1");
  described.scalar("kinetic_temperature", "k_B T", "energy");
  described.scalar("rotational_temperature", "k_B T_rot", "energy");
  return described.take();
}

}  // namespace peclet::engine
