#include "engine/output/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/kernels/instruction_set.h"
#include "engine/kernels/pairs/terms.h"
#include "engine/observables/catalogue.h"
#include "engine/stability/derived_groups.h"
#include "engine/stability/stability.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

Json to_json(const SymmetricTensor& t) { return {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}; }

double first_normal_difference(const SymmetricTensor& t) { return t.xx - t.yy; }
double second_normal_difference(const SymmetricTensor& t) { return t.yy - t.zz; }
double pressure(const SymmetricTensor& t) { return -(t.xx + t.yy + t.zz) / 3; }

// Turns sums into means in the units of the result.
class Reduction {
 public:
  Reduction(const Scene& scene, const Simulation& simulation)
      : physics_(scene.physics),
        terms_(required_terms(scene.physics)),
        volume_(simulation.system().box.volume()),
        volume_fraction_(solid_volume(simulation.system().particles) / volume_),
        particles_(static_cast<double>(simulation.system().particles.count())),
        unit_(physics_.shear_rate > 0 ? physics_.viscosity * physics_.shear_rate : 1) {}

  Json means(const BlockSums& sums) const {
    Json stress = Json::object();
    SymmetricTensor total;
    const auto part = [&](const char* name, const SymmetricTensor& value) {
      stress[name] = to_json(value);
      total += value;
    };
    if (physics_.shear_rate > 0) {
      const SymmetricTensor solvent = solvent_stress(1, 1);  // in units of itself
      part("solvent", solvent);
      part("stresslet", stresslet(volume_fraction_, solvent));
    }
    const double per_step = 1 / (static_cast<double>(sums.steps) * volume_ * unit_);
    SymmetricTensor pairs, brownian;
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      const auto term = static_cast<StressTerm>(t);
      const SymmetricTensor mean = per_step * sums.stress[t];
      if (term == StressTerm::brownian_lubrication) {
        brownian = mean;  // of mean zero: never part of the total
      } else if (has_stress_term(physics_, term)) {
        part(name_of(term), mean);
        pairs += mean;
      }
    }
    stress["total"] = to_json(total);
    const bool sheared = physics_.shear_rate > 0;
    const double per_sample = 1 / static_cast<double>(sums.samples);
    return {{"stress", stress},
            {"brownian_pairwise", to_json(brownian)},
            {"brownian_structural", to_json((per_sample / unit_) * sums.structural_brownian)},
            {"relative_viscosity", sheared ? Json(total.xy) : Json()},
            {"relative_viscosity_pair", sheared ? Json(pairs.xy) : Json()},
            {"first_normal_difference", first_normal_difference(total)},
            {"second_normal_difference", second_normal_difference(total)},
            {"pressure", pressure(total)},
            {"control_variates", control_variates(brownian)},
            {"contacts_per_particle", 2 * sums.contacts / (static_cast<double>(sums.steps) * particles_)},
            {"kinetic_temperature", per_sample * sums.temperature.translational},
            {"rotational_temperature", per_sample * sums.temperature.rotational}};
  }

 private:
  // Of mean zero: the part that the stress of the pairwise noise would have in each observable. That of the
  // relative viscosities is named after the stress.
  Json control_variates(const SymmetricTensor& brownian) const {
    const auto value = [&](double number) { return terms_.noise ? Json(number) : Json(); };
    return {{"brownian_pairwise", value(brownian.xy)},
            {"first_normal_difference", value(first_normal_difference(brownian))},
            {"second_normal_difference", value(second_normal_difference(brownian))},
            {"pressure", value(pressure(brownian))}};
  }

  const Physics& physics_;
  Terms terms_;
  double volume_, volume_fraction_, particles_, unit_;
};

BlockSums whole_window(const Production& production) {
  BlockSums all;
  for (const BlockSums& block : production.blocks()) {
    all.steps += block.steps;
    all.samples += block.samples;
    all.contacts += block.contacts;
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      all.stress[t] += block.stress[t];
    }
    all.structural_brownian += block.structural_brownian;
    all.temperature.translational += block.temperature.translational;
    all.temperature.rotational += block.temperature.rotational;
  }
  return all;
}

// Five significant digits: far below the scatter of a block, and less than half the room of all seventeen.
Json rounded(const Json& number) {
  if (!number.is_number()) return number;
  return std::stod(fmt::format("{:.5g}", number.get<double>()));
}

// What is kept of each block's means: all that is one number, and xy of every stress that fluctuates. The
// total is the relative viscosity.
Json of_block(const Json& means) {
  Json kept;
  for (const auto& [name, value] : means.items()) {
    if (!value.is_structured()) kept[name] = rounded(value);
  }
  for (const auto& [name, value] : means.at("control_variates").items()) {
    kept["control_variates"][name] = rounded(value);
  }
  for (const auto& [term, stress] : means.at("stress").items()) {
    if (term != "solvent" && term != "stresslet" && term != "total") {
      kept["shear_stress"][term] = rounded(stress.at(3));
    }
  }
  kept["shear_stress"]["brownian_structural"] = rounded(means.at("brownian_structural").at(3));
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

// Energy made by the step over the work of the flow on pairs, in the production window. Without flow there is
// no work; noise does work by itself, so that the balance says nothing about the step.
std::optional<double> energy_imbalance(const Scene& scene, const Simulation& simulation) {
  const BlockSums window = whole_window(simulation.production());
  const StepErrors& errors = simulation.step_errors();
  double work_per_step = 0;
  for (const SymmetricTensor& stress : window.stress) {
    work_per_step += simulation.schedule().timestep * scene.physics.shear_rate * stress.xy /
                     static_cast<double>(window.steps);
  }
  if (scene.physics.thermal_energy > 0 || errors.samples == 0 || !(work_per_step > 0)) {
    return std::nullopt;
  }
  return errors.spurious_energy / static_cast<double>(errors.samples) / work_per_step;
}

// How much more stress the samples have with whole steps than with half ones, relative to the latter.
std::optional<double> half_step_difference(const StepErrors& errors) {
  const auto [whole, halved] = errors.half_steps;
  if (!(halved > 0)) {
    return std::nullopt;
  }
  return whole / halved - 1;
}

Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

// Beyond this the equations of implicit steps cannot be called solved. In results/implicit-steps it is 0.007
// with friction at a step of 0.09 and 0.028 at one of 0.2, where half steps change the stress by 3 %.
constexpr double largest_mean_residual = 0.015;

// How well implicit steps have solved their equations, in the production window.
Json solver_json(const Scene& scene, const Simulation& simulation) {
  const StepErrors& errors = simulation.step_errors();
  const auto steps = static_cast<double>(whole_window(simulation.production()).steps);
  if (scene.method != Method::implicit_steps || steps == 0) {
    return nullptr;
  }
  return {{"iterations_per_step", static_cast<double>(errors.solver_iterations) / steps},
          {"mean_residual", errors.sum_of_solver_residuals / steps},
          {"largest_residual", errors.largest_solver_residual}};
}

Json ending_json(const Ending& ending, const std::string& saved_state) {
  return {{"cause", name_of(ending.cause)},
          {"step", ending.step},
          {"message", ending.message},
          {"state", saved_state.empty() ? Json() : Json(saved_state)}};
}

Json warnings_json(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const Warning& warning : warnings) {
    list.push_back({{"code", warning.code}, {"message", warning.message}});
  }
  return list;
}

Json common_part(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                 std::uint64_t steps, const Spent& spent) {
  const double dt = schedule.timestep, rate = scene.physics.shear_rate;
  const std::uint64_t before = std::min(steps, schedule.equilibration), after = steps - before;
  const auto of_phases = [&](double factor) {
    return Json{{"equilibration", factor * static_cast<double>(before)},
                {"production", factor * static_cast<double>(after)}};
  };
  return {{"schema_version", 1},
          {"point", header.point},
          {"seed", header.seed},
          {"method", scene.method == Method::implicit_steps ? "implicit" : "explicit"},
          {"timestep", dt},
          {"steps", {{"equilibration", before}, {"production", after}}},
          {"time", of_phases(dt)},
          {"strain", of_phases(dt * rate)},
          {"derived", to_json(derived_groups(scene))},
          {"units", rate > 0 ? "viscosity * shear_rate" : "scene"},
          {"mean", nullptr},
          {"blocks", nullptr},
          {"statistical_inefficiency", nullptr},
          {"cost", {{"cpu_seconds", spent.processor_seconds}, {"wall_seconds", spent.wall_seconds}}},
          {"engine", engine_identity()}};
}

}  // namespace

Json make_result(const ResultHeader& header, const Scene& scene, const Simulation& simulation,
                 const Ending& ending, const std::string& saved_state, const Spent& spent) {
  Json result = common_part(header, scene, simulation.schedule(), simulation.system().step, spent);
  std::vector<Warning> warnings = scene_warnings(scene);
  if (const double overlap = simulation.largest_overlap(); overlap > 0.01) {
    warnings.push_back(
        {"overlap", "spheres overlapped by " + Json(overlap).dump() +
                        " of a radius, more than 0.01: the contacts are too soft for this stress"});
  }
  const std::optional<double> imbalance = energy_imbalance(scene, simulation);
  if (imbalance && std::abs(*imbalance) > scene.guard.energy_imbalance) {
    warnings.push_back({"timestep", "the step makes " + Json(*imbalance).dump() +
                                        " times the energy that the flow puts in, more than " +
                                        Json(scene.guard.energy_imbalance).dump() +
                                        ": the stress may depend on the step, choose a smaller one"});
  }
  const std::optional<double> difference = half_step_difference(simulation.step_errors());
  if (difference && std::abs(*difference) > scene.guard.half_step_difference) {
    warnings.push_back({"timestep", "half steps change the stress by " + Json(-*difference).dump() +
                                        " of it, more than " + Json(scene.guard.half_step_difference).dump() +
                                        ": choose a smaller step"});
  }
  const Json solver = solver_json(scene, simulation);
  if (!solver.is_null() && solver["mean_residual"] > largest_mean_residual) {
    warnings.push_back({"solver", "the equations of the steps are left with a residual of " +
                                      solver["mean_residual"].dump() + " of the motion, more than " +
                                      Json(largest_mean_residual).dump() + ": choose a smaller step"});
  }
  result["warnings"] = warnings_json(warnings);
  result["gate"] = {{"largest_stability_share", simulation.step_errors().largest_stability_share},
                    {"energy_imbalance", or_null(imbalance)},
                    {"half_step_difference", or_null(difference)},
                    {"solver", solver}};
  result["ending"] = ending_json(ending, saved_state);
  result["largest_overlap"] = simulation.largest_overlap();
  ArchiveWriter state;
  save(simulation.system(), state);
  result["final_state_sha256"] = sha256(state.bytes());
  if (ending.cause == Ending::Cause::completed) {
    const Reduction reduction(scene, simulation);
    std::vector<Json> blocks;
    std::vector<double> series;
    for (const BlockSums& block : simulation.production().blocks()) {
      const Json means = reduction.means(block);
      const Json& value = means.at(scene.physics.shear_rate > 0 ? "relative_viscosity" : "pressure");
      series.push_back(value.get<double>());
      blocks.push_back(of_block(means));
    }
    result["mean"] = reduction.means(whole_window(simulation.production()));
    for (const std::unique_ptr<Observable>& observable : simulation.observables()) {
      observable->add_to(result["mean"]);
    }
    result["blocks"] = transposed(blocks);
    result["statistical_inefficiency"] = statistical_inefficiency(series);
  }
  return result;
}

Json make_unpacked_result(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                          const std::string& message, const Spent& spent) {
  Json result = common_part(header, scene, schedule, 0, spent);
  result["warnings"] = warnings_json(scene_warnings(scene));
  result["gate"] = nullptr;
  result["ending"] = ending_json({Ending::Cause::packing, 0, message}, "");
  result["largest_overlap"] = nullptr;
  result["final_state_sha256"] = nullptr;
  return result;
}

std::vector<std::string> names_of_means(const Scene& scene) {
  std::vector<std::string> names{"contacts_per_particle",  "first_normal_difference",
                                 "kinetic_temperature",    "pressure",
                                 "rotational_temperature", "second_normal_difference"};
  if (scene.physics.shear_rate > 0) {
    names.emplace_back("relative_viscosity");
    names.emplace_back("relative_viscosity_pair");
  }
  for (const std::string& name : names_of_numbers(scene)) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

const Json& engine_identity() {
  static const Json identity = [] {
    Json all = provenance();
    // Besides the kernels, the C library picks its functions by what the processor has.
    std::string set = name_of(chosen_instruction_set());
#ifdef __x86_64__
    set += __builtin_cpu_supports("fma") != 0 ? ", libm with fma" : "";
#endif
    all["instruction_set"] = set;
    return all;
  }();
  return identity;
}

}  // namespace peclet::engine
