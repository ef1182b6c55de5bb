#include "engine/realisation/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/provenance.h"
#include "contract/sha256.h"
#include "engine/flow/controlled_shear.h"
#include "engine/integrators/derived_groups.h"
#include "engine/integrators/stability.h"
#include "engine/kernels/instruction_set.h"
#include "engine/observables/observable.h"
#include "engine/observables/production.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/schedule.h"
#include "engine/realisation/stress_means.h"

namespace peclet::engine {
namespace {

// Returns the energy error of the steps over the work of the flow on pairs, in the production window. Returns
// nothing without flow, because there is no work, and with noise, which does work itself.
std::optional<double> energy_imbalance(const Scene& scene, const Simulation& simulation) {
  const BlockSums window = sum_of(simulation.production().blocks());
  const StepErrors& errors = simulation.step_errors();
  double work_per_step = 0;
  const ImposedFlow& flow = scene.physics.flow;
  for (const SymmetricTensor& stress : window.stress) {
    work_per_step += simulation.schedule().timestep * flow.steady_rate() * flow.shear_part(stress) /
                     static_cast<double>(window.steps);
  }
  // Waves and oscillations do work that this balance omits.
  if (!flow.is_steady() || scene.physics.thermal_energy > 0 || errors.samples == 0 || !(work_per_step > 0)) {
    return std::nullopt;
  }
  return errors.spurious_energy / static_cast<double>(errors.samples) / work_per_step;
}

// Returns the stress of the samples with whole steps over the one with half steps, less 1.
std::optional<double> half_step_difference(const StepErrors& errors) {
  const auto [whole, halved] = errors.half_steps;
  if (!(halved > 0)) return std::nullopt;
  return whole / halved - 1;
}

// Mean relative residual of implicit steps above which the result gets a warning. In results/speed-accuracy,
// with friction at phi = 0.45, it is 0.005 at the automatic step, and 0.028 at four times that step, where
// the viscosity is 6 % off.
constexpr double largest_mean_residual = 0.015;

// Share of divided steps above which the result gets a warning: the step is then not the one that was chosen.
constexpr double largest_share_divided = 0.1;

// Returns the accuracy of the solver of implicit steps in the production window; null for explicit steps.
Json solver_json(const Scene& scene, const Simulation& simulation) {
  const StepErrors& errors = simulation.step_errors();
  const auto steps = static_cast<double>(sum_of(simulation.production().blocks()).steps);
  if (scene.method != Method::implicit_steps || steps == 0) return nullptr;
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

// Returns what computed a result.
Json engine_of(const ResultHeader& header) {
  if (header.ensemble.empty()) return engine_identity();
  Json engine = engine_identity(header.ensemble);
  engine["device"] = header.in_ensemble ? header.ensemble : "processor";
  return engine;
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
          {"engine", engine_of(header)}};
}

// Returns the statistical_inefficiency() of the block means of every scalar.
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

// Replaces numbers that are not finite by null: means and blocks may be undefined if a run jammed early.
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
  // A viscosity at rest is not a mean of the stress: it has no blocks.
  if (scene.physics.flow.steady_rate() == 0 && !mean.at("relative_viscosity").is_null())
    blocks.erase("relative_viscosity");
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

std::string line(const char* name, const std::string& text) { return fmt::format("{:<12}{}\n", name, text); }

// Returns the standard error of the mean of a correlated series; 0 if all values are equal.
double standard_error(const std::vector<double>& series) {
  const auto n = static_cast<double>(series.size());
  double mean = 0, squares = 0;
  for (const double x : series) mean += x / n;
  for (const double x : series) squares += (x - mean) * (x - mean);
  return std::sqrt(statistical_inefficiency(series) * squares / (n - 1) / n);
}

std::string with_error(const Json& result, const char* name) {
  const double mean = result.at("mean").at(name).get<double>();
  std::vector<double> series;  // blocks after a jam are null
  for (const Json& block : result.at("blocks").at(name)) {
    if (block.is_number()) series.push_back(block.get<double>());
  }
  if (series.size() < 2) return fmt::format("{:.4g}", mean);
  return fmt::format("{:.4g} ± {:.2g}", mean, standard_error(series));
}

std::string means(const Json& result) {
  const bool sheared = result.at("units") != "scene";
  const auto value = [&](const char* name) { return with_error(result, name); };
  std::string text;
  if (sheared) {
    text += line("viscosity", fmt::format("{} relative to the solvent; {} of pairs alone",
                                          value("relative_viscosity"), value("relative_viscosity_pair")));
  }
  const Json& mean = result.at("mean");
  if (mean.contains("shear_rate")) {
    const Json& viscosity = mean.at("apparent_viscosity");
    const double stress = viscosity.at("stress").get<double>();
    const double viscous = viscosity.at("viscous_stress").get<double>();
    const std::string relative =
        viscous > 0 ? fmt::format("; viscosity {:.4g} relative to the solvent", stress / viscous) : "";
    const std::string rate = result.at("ending").at("cause") == name_of(Ending::Cause::jammed)
                                 ? fmt::format("{:.4g}", mean.at("shear_rate").get<double>())
                                 : value("shear_rate");
    text += line("shear rate", fmt::format("{} at a stress of {:.4g}{}", rate, stress, relative));
  }
  if (mean.value("loss_modulus", Json()).is_number()) {
    const auto number = [&](const char* name) { return mean.at(name).get<double>(); };
    text += line("moduli",
                 fmt::format("G' {:.4g}, G'' {:.4g}, in units of the scene; G''/(eta w) {:.4g}",
                             number("storage_modulus"), number("loss_modulus"), number("dynamic_viscosity")));
  }
  const char* const unit = sheared ? " viscosity * shear rate" : ", in units of the scene";
  text += line("N1, N2", fmt::format("{}, {}{}", value("first_normal_difference"),
                                     value("second_normal_difference"), unit));
  text += line("pressure", value("pressure") + unit);
  text += line("contacts", fmt::format("{} per sphere; overlaps {:.2g} radii in the mean, {:.2g} at most",
                                       value("contacts_per_particle"), mean.at("mean_overlap").get<double>(),
                                       result.at("largest_overlap").get<double>()));
  return text;
}

std::string steps(const Json& result) {
  const Json& strain = result.at("strain");
  return fmt::format("{} + {} {} steps of {:.4g}, strain of {:.4g} + {:.4g}",
                     result.at("steps").at("equilibration").get<std::uint64_t>(),
                     result.at("steps").at("production").get<std::uint64_t>(),
                     result.at("method").get<std::string>(), result.at("timestep").get<double>(),
                     strain.at("equilibration").get<double>(), strain.at("production").get<double>());
}

std::string warnings(const Json& result) {
  std::string text;
  for (const Json& warning : result.at("warnings")) {
    text += line("warning", fmt::format("{}: {}", warning.at("code").get<std::string>(),
                                        warning.at("message").get<std::string>()));
  }
  return text.empty() ? line("warnings", "none") : text;
}

// Returns the mean shear stress of a steady flow; empty if it has jammed or is not steady.
std::optional<double> shear_stress(const Scene& scene, const Ending& ending, const Json& mean) {
  if (ending.cause == Ending::Cause::jammed) return {};
  const ImposedFlow& flow = scene.physics.flow;
  if (const ControlledShear* const held = flow.deformation().at_stress()) return held->stress();
  const Json& viscosity = mean.at("relative_viscosity");
  if (!(flow.steady_rate() > 0) || !viscosity.is_number()) return {};
  return scene.physics.viscosity * flow.steady_rate() * viscosity.get<double>();
}

}  // namespace

Json make_result(const ResultHeader& header, const Scene& scene, const Simulation& simulation,
                 const Ending& ending, const std::string& saved_state, const Spent& spent) {
  Json result = common_part(header, scene, simulation.schedule(), simulation.system().step,
                            simulation.strains(), spent);
  std::vector<Warning> warnings = scene_warnings(scene);
  if (const double overlap = sum_of(simulation.production().blocks()).mean_overlap(); overlap > 0.001) {
    warn(warnings, "overlap",
         "contacts overlapped by {:.3g} of a radius in the mean, more than 0.001: they are "
         "too soft for this stress, and spheres take up less than their volume fraction",
         overlap);
  }
  const std::optional<double> imbalance = energy_imbalance(scene, simulation);
  if (imbalance && std::abs(*imbalance) > scene.guard.energy_imbalance) {
    warn(warnings, "timestep",
         "the step makes {:.3g} times the energy that the flow puts in, more than {:.3g}: "
         "the stress may depend on the step, choose a smaller one",
         *imbalance, scene.guard.energy_imbalance);
  }
  const std::optional<double> difference = half_step_difference(simulation.step_errors());
  if (difference && std::abs(*difference) > scene.guard.half_step_difference) {
    warn(warnings, "timestep",
         "half steps change the stress by a fraction of {:.3g}, more than {:.3g}: choose a smaller step",
         -*difference, scene.guard.half_step_difference);
  }
  const Json solver = solver_json(scene, simulation);
  if (!solver.is_null() && solver["mean_residual"] > largest_mean_residual) {
    warn(warnings, "solver",
         "the equations of the steps have a mean residual of {:.3g}, relative to the motion, more than "
         "{:.3g}: choose a smaller step",
         solver["mean_residual"].get<double>(), largest_mean_residual);
  }
  if (!solver.is_null()) {
    const auto steps = static_cast<double>(sum_of(simulation.production().blocks()).steps);
    const double share = solver["divided_steps"].get<double>() / steps;
    if (share > largest_share_divided) {
      warn(warnings, "timestep",
           "a fraction {0:.2g} of the steps, more than {2}, was divided, down to 1/{1} of a step, because "
           "spheres would have moved too far: choose a smaller step",
           share, 1 << solver["deepest_division"].get<int>(), largest_share_divided);
    }
  }
  if (ending.cause == Ending::Cause::jammed) {
    warnings.push_back({"jammed", ending.message + "; its rate is 0, and it has no viscosity"});
  }
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
    if (const std::optional<double> stress = shear_stress(scene, ending, result["mean"]))
      warn_of_step_at_onset_of_friction(scene, simulation.schedule().timestep, *stress, warnings);
  }
  result["warnings"] = warnings;
  return result;
}

Json make_unpacked_result(const ResultHeader& header, const Scene& scene, const Schedule& schedule,
                          const std::string& message, const Spent& spent) {
  Json result = common_part(header, scene, schedule, 0, {}, spent);
  result["warnings"] = scene_warnings(scene);
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
  const std::vector<Quantity> always = StressMeans(scene).quantities();
  for (const ObservableKind& kind : observable_kinds()) {
    if (scene.observables.contains(kind.name)) continue;
    const std::string hint = fmt::format("needs \"observables\": [\"{}\"] in the scene", kind.name);
    hints[kind.name] = hint;
    for (const std::string& number : kind.numbers) {
      const auto is_it = [&](const Quantity& quantity) { return quantity.name == number; };
      if (std::none_of(always.begin(), always.end(), is_it)) hints[number] = hint;
    }
  }
  for (const auto& [name, meant] : called) {
    hints[name] = fmt::format("is called {}", meant);
    if (hints.contains(meant))
      hints[name] = fmt::format("is called {}, which {}", meant, hints[meant].get<std::string>());
  }
  if (scene.physics.flow.deformation().at_stress() != nullptr) {
    for (const char* const name : {"apparent_viscosity", "relative_viscosity", "eta_r", "eta", "viscosity"}) {
      hints[name] =
          "follows from the mean rate at a given stress: name shear_rate, whose relative error is the same; "
          "`peclet plot --quantity apparent_viscosity` draws it";
    }
  }
  return hints;
}

const Json& engine_identity() {
  static const Json identity = [] {
    Json all = provenance();
    // The C library, too, chooses its functions by the processor.
    std::string set = name_of(chosen_instruction_set());
#ifdef __x86_64__
    set += __builtin_cpu_supports("fma") != 0 ? ", libm with fma" : "";
#endif
    all["instruction_set"] = set;
    return all;
  }();
  return identity;
}

Json engine_identity(const std::string& ensemble) {
  Json all = engine_identity();
  all["instruction_set"] = ensemble + "; " + all["instruction_set"].get<std::string>();
  return all;
}

std::string summary(const Json& result, const std::string& place) {
  const Json& cost = result.at("cost");
  return means(result) + line("errors", "± standard error within this run, of one seed") +
         line("steps", steps(result)) + warnings(result) +
         line("cost",
              fmt::format("{:.3g} s of processor time in {:.3g} s", cost.at("cpu_seconds").get<double>(),
                          cost.at("wall_seconds").get<double>())) +
         line("result", fmt::format("seed {}, {}", result.at("seed").get<std::uint64_t>(), place));
}

std::string result_text(const Json& result) {
  constexpr const char* first[] = {"schema_version",           "point",   "seed", "ending", "units", "mean",
                                   "statistical_inefficiency", "warnings"};
  constexpr const char* last = "blocks";
  nlohmann::ordered_json ordered = nlohmann::ordered_json::object();
  for (const char* name : first) ordered[name] = result.at(name);
  for (const auto& [name, value] : result.items()) {
    if (name != last && !ordered.contains(name)) ordered[name] = value;
  }
  ordered[last] = result.at(last);
  return ordered.dump(1) + "\n";
}

}  // namespace peclet::engine
