#include "engine/output/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/kernels/instruction_set.h"
#include "engine/observables/observable.h"
#include "engine/output/stress_means.h"
#include "engine/stability/derived_groups.h"
#include "engine/stability/stability.h"
#include "engine/start/packing.h"

namespace peclet::engine {
namespace {

// Energy made by the step over the work of the flow on pairs, in the production window. Without flow there is
// no work; noise does work by itself, so that the balance says nothing about the step.
std::optional<double> energy_imbalance(const Scene& scene, const Simulation& simulation) {
  const BlockSums window = sum_of(simulation.production().blocks());
  const StepErrors& errors = simulation.step_errors();
  double work_per_step = 0;
  const ImposedFlow& flow = scene.physics.flow;
  for (const SymmetricTensor& stress : window.stress) {
    work_per_step += simulation.schedule().timestep * flow.steady_rate() * flow.shear_part(stress) /
                     static_cast<double>(window.steps);
  }
  // Waves and oscillations do work that this balance leaves out.
  if (!flow.is_steady() || scene.physics.thermal_energy > 0 || errors.samples == 0 || !(work_per_step > 0)) {
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

// Beyond this the equations of implicit steps cannot be called solved. In results/speed-accuracy, with
// friction at phi = 0.45, it is 0.005 at the automatic step and 0.028 at four times that, whose viscosity is
// 6 % off.
constexpr double largest_mean_residual = 0.015;

// Where more of the steps are divided, the step is no longer the one that was chosen.
constexpr double largest_share_divided = 0.1;

// How well implicit steps have solved their equations, in the production window.
Json solver_json(const Scene& scene, const Simulation& simulation) {
  const StepErrors& errors = simulation.step_errors();
  const auto steps = static_cast<double>(sum_of(simulation.production().blocks()).steps);
  if (scene.method != Method::implicit_steps || steps == 0) {
    return nullptr;
  }
  return {{"iterations_per_step", static_cast<double>(errors.solver_iterations) / steps},
          {"mean_residual", errors.sum_of_solver_residuals / steps},
          {"largest_residual", errors.largest_solver_residual},
          {"divided_steps", errors.divided_steps},
          {"deepest_division", errors.deepest_division}};
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
                 std::uint64_t steps, const Strains& strains, const Spent& spent) {
  const double dt = schedule.timestep;
  const ImposedFlow& flow = scene.physics.flow;
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
          {"strain", {{"equilibration", strains.equilibration}, {"production", strains.production}}},
          {"derived", to_json(derived_groups(scene))},
          {"units", flow.steady_rate() > 0 ? "viscosity * shear_rate" : "scene"},
          {"mean", nullptr},
          {"blocks", nullptr},
          {"quantities", nullptr},
          {"inefficiencies", nullptr},
          {"statistical_inefficiency", nullptr},
          {"cost", {{"cpu_seconds", spent.processor_seconds}, {"wall_seconds", spent.wall_seconds}}},
          {"engine", engine_identity()}};
}

// 1 + 2 sum of the autocorrelation: statistical_inefficiency() of the block means of every scalar.
Json inefficiencies(const Json& blocks, const std::vector<Quantity>& quantities) {
  Json all = Json::object();
  for (const Quantity& quantity : quantities) {
    const Json::json_pointer place('/' + quantity.name);
    if (!quantity.axes.empty() || !blocks.contains(place)) continue;
    const Json& series = blocks.at(place);
    const auto is_number = [](const Json& block) { return block.is_number(); };
    if (!std::all_of(series.begin(), series.end(), is_number)) continue;
    all[quantity.name] = statistical_inefficiency(series.get<std::vector<double>>());
  }
  return all;
}

std::vector<Quantity> quantities_of(const StressMeans& stress,
                                    const std::vector<std::unique_ptr<Observable>>& observables) {
  std::vector<Quantity> all = stress.quantities();
  for (const std::unique_ptr<Observable>& observable : observables) {
    all.insert(all.end(), observable->quantities().begin(), observable->quantities().end());
  }
  return all;
}

// What ended before its window has parts of which nothing is known.
void leave_no_nans(Json& value) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) value = nullptr;
  if (!value.is_structured()) return;
  for (Json& part : value) leave_no_nans(part);
}

void add_measurements(const Scene& scene, const Simulation& simulation, const Ending& ending, Json& result) {
  const StressMeans stress(scene);
  const System& system = simulation.system();
  const std::vector<Quantity> quantities = quantities_of(stress, simulation.observables());
  Json &mean = result["mean"], &blocks = result["blocks"];
  mean =
      stress.means(system, sum_of(simulation.production().blocks()), ending.cause == Ending::Cause::jammed);
  blocks = stress.blocks(system, simulation.production());
  const char* const usual = scene.physics.flow.steady_rate() > 0 ? "/relative_viscosity" : "/pressure";
  for (const std::unique_ptr<Observable>& observable : simulation.observables()) {
    observable->add_to(mean);
    observable->add_blocks_to(blocks);
  }
  leave_no_nans(mean);
  leave_no_nans(blocks);
  result["inefficiencies"] = inefficiencies(blocks, quantities);
  std::vector<double> series;
  for (const BlockSums& block : simulation.production().blocks()) {
    if (block.samples > 0) {
      series.push_back(stress.means(system, block).at(Json::json_pointer(usual)).get<double>());
    }
  }
  result["statistical_inefficiency"] = statistical_inefficiency(series);
  for (const Quantity& quantity : quantities) result["quantities"][quantity.name] = to_json(quantity);
}

}  // namespace

Json make_result(const ResultHeader& header, const Scene& scene, const Simulation& simulation,
                 const Ending& ending, const std::string& saved_state, const Spent& spent) {
  Json result = common_part(header, scene, simulation.schedule(), simulation.system().step,
                            simulation.strains(), spent);
  std::vector<Warning> warnings = scene_warnings(scene);
  if (const double overlap = sum_of(simulation.production().blocks()).mean_overlap(); overlap > 0.001) {
    warnings.push_back(
        {"overlap",
         fmt::format("contacts overlapped by {:.3g} of a radius in the mean, more than 0.001: they are "
                     "too soft for this stress, and spheres take up less than their volume fraction",
                     overlap)});
  }
  const std::optional<double> imbalance = energy_imbalance(scene, simulation);
  if (imbalance && std::abs(*imbalance) > scene.guard.energy_imbalance) {
    warnings.push_back(
        {"timestep",
         fmt::format("the step makes {:.3g} times the energy that the flow puts in, more than {:.3g}: "
                     "the stress may depend on the step, choose a smaller one",
                     *imbalance, scene.guard.energy_imbalance)});
  }
  const std::optional<double> difference = half_step_difference(simulation.step_errors());
  if (difference && std::abs(*difference) > scene.guard.half_step_difference) {
    warnings.push_back(
        {"timestep",
         fmt::format("half steps change the stress by {:.3g} of it, more than {:.3g}: choose a smaller "
                     "step",
                     -*difference, scene.guard.half_step_difference)});
  }
  const Json solver = solver_json(scene, simulation);
  if (!solver.is_null() && solver["mean_residual"] > largest_mean_residual) {
    warnings.push_back(
        {"solver",
         fmt::format("the equations of the steps are left with a residual of {:.3g} of the motion, more "
                     "than {:.3g}: choose a smaller step",
                     solver["mean_residual"].get<double>(), largest_mean_residual)});
  }
  if (!solver.is_null()) {
    const auto steps = static_cast<double>(sum_of(simulation.production().blocks()).steps);
    const double share = solver["divided_steps"].get<double>() / steps;
    if (share > largest_share_divided) {
      warnings.push_back(
          {"timestep",
           fmt::format("{:.2g} of the steps were divided, down to 1/{}, because "
                       "spheres would have leapt, more than {}: choose a smaller step",
                       share, 1 << solver["deepest_division"].get<int>(), largest_share_divided)});
    }
  }
  if (ending.cause == Ending::Cause::jammed) {
    warnings.push_back({"jammed", ending.message + "; its rate is 0, and it has no viscosity"});
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
  if (is_measured(ending.cause)) {
    add_measurements(scene, simulation, ending, result);
  }
  return result;
}

Json make_unpacked_result(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                          const std::string& message, const Spent& spent) {
  Json result = common_part(header, scene, schedule, 0, {}, spent);
  result["warnings"] = warnings_json(scene_warnings(scene));
  result["gate"] = nullptr;
  result["ending"] = ending_json({Ending::Cause::packing, 0, message}, "");
  result["largest_overlap"] = nullptr;
  result["final_state_sha256"] = nullptr;
  return result;
}

std::vector<std::string> names_of_targets(const Scene& scene, const Schedule& schedule) {
  const Vector3 box = box_lengths(scene, cube_edge(scene.particles, scene.volume_fraction));
  const auto observables = make_observables(scene, {schedule.timestep, schedule.production, box}, "scene");
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities_of(StressMeans(scene), observables)) {
    for (std::string& name : targets_in(quantity)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  return names;
}

Json target_hints(const Scene& scene) {
  constexpr std::pair<const char*, const char*> called[] = {{"eta_r", "relative_viscosity"},
                                                            {"eta", "relative_viscosity"},
                                                            {"viscosity", "relative_viscosity"},
                                                            {"N1", "first_normal_difference"},
                                                            {"N_1", "first_normal_difference"},
                                                            {"N2", "second_normal_difference"},
                                                            {"N_2", "second_normal_difference"},
                                                            {"P", "pressure"},
                                                            {"p", "pressure"},
                                                            {"Z", "contacts_per_particle"},
                                                            {"G'", "storage_modulus"},
                                                            {"G''", "loss_modulus"},
                                                            {"shear_stress", "stress/total/3"}};
  Json hints = Json::object();
  for (const ObservableKind& kind : observable_kinds()) {
    if (scene.observables.contains(kind.name)) continue;
    const std::string hint = fmt::format("needs \"observables\": [\"{}\"] in the scene", kind.name);
    hints[kind.name] = hint;
    for (const std::string& number : kind.numbers) hints[number] = hint;
  }
  for (const auto& [name, meant] : called) {
    hints[name] = fmt::format("is called {}", meant);
    if (hints.contains(meant))
      hints[name] = fmt::format("is called {}, which {}", meant, hints[meant].get<std::string>());
  }
  if (scene.physics.flow.deformation().at_stress() != nullptr) {
    for (const char* const name : {"relative_viscosity", "eta_r", "eta", "viscosity"})
      hints[name] = "follows from the mean rate at a given stress: aim at shear_rate";
  }
  return hints;
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
