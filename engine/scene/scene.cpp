// What a scene means: the rules that bind several keys, and the values that follow from others.
#include "engine/scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/errors.h"
#include "engine/flow/controlled_shear.h"
#include "engine/flow/flow_kind.h"
#include "engine/flow/waves.h"
#include "engine/scene/law_blocks.h"
#include "engine/scene/particles_block.h"
#include "engine/scene/start_block.h"

namespace peclet::engine {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The checks of one document.
class Reading : public SceneDocument {
 public:
  using SceneDocument::SceneDocument;
  explicit Reading(const SceneDocument& document) : SceneDocument(document) {}

  Particles particles() const { return read_particles(*this); }
  double volume_fraction(const Particles& particles) const { return read_volume_fraction(*this, particles); }
  Physics physics() const;
  void check_lubrication(const Particles& particles, const Physics& physics) const;
  Duration duration(const std::string& pointer, const Physics& physics) const;
  Duration phase(const std::string& pointer, const Physics& physics) const;
  // That the production window, which begins then, ends, and in time.
  void check_window(const Scene& scene, double begin) const;
  std::optional<Start> start() const {
    return has("/start") ? std::optional<Start>(read_start(*this)) : std::nullopt;
  }
};

Physics Reading::physics() const {
  Physics physics;
  physics.viscosity = number("/fluid/viscosity");
  physics.thermal_energy = number_or("/fluid/thermal_energy", 0);
  for (const LawBlock& law : law_blocks) {
    if (has("/" + std::string(law.name))) law.read(*this, physics);
  }
  return physics;
}

void Reading::check_lubrication(const Particles& particles, const Physics& physics) const {
  if (!physics.lubrication) return;
  const auto by_radius = [](const Species& a, const Species& b) { return a.radius < b.radius; };
  const double smallest = std::ranges::min_element(particles.species, by_radius)->radius;
  if (const std::optional<std::string> fault = fault_of_outer_distance(*physics.lubrication, smallest)) {
    refuse("/lubrication/outer_distance", *fault);
  }
}

Duration Reading::duration(const std::string& pointer, const Physics& physics) const {
  const Json& limits = at(pointer);
  if (limits.empty())
    refuse(pointer, "must have at least one of strain, brownian_times, time, cycles, stress_times");
  check_duration(*this, flow_kind_of(*this), pointer);
  Duration duration;
  if (physics.flow.rate() > 0) duration.strain = limits.value("strain", unlimited);
  if (physics.thermal_energy > 0) duration.brownian_times = limits.value("brownian_times", unlimited);
  duration.time = limits.value("time", unlimited);
  if (limits.contains("stress_times")) {
    const double unit = physics.flow.deformation().at_stress()->stress_time();
    duration.time = std::min(duration.time, limits.at("stress_times").get<double>() * unit);
  }
  for (const auto& [name, limit] : limits.items()) {
    // Over before it starts, whatever the flow.
    if (limit == 0 && name != "cycles") duration = {unlimited, unlimited, 0};
  }
  const auto is_unlimited = [&] {
    return duration.strain == unlimited && duration.brownian_times == unlimited && duration.time == unlimited;
  };
  if (limits.contains("cycles")) {
    duration.least_time = limits.at("cycles").get<double>() * *physics.flow.period();
    if (is_unlimited()) duration.time = duration.least_time;
  }
  if (is_unlimited()) {
    refuse(pointer,
           "would never end: strain needs a shear rate > 0, brownian_times a thermal energy > 0; give one of "
           "them "
           "that is reached, or time");
  }
  return duration;
}

// One of the two of a realisation: of whole cycles where moduli are measured.
Duration Reading::phase(const std::string& pointer, const Physics& physics) const {
  Duration duration = this->duration(pointer, physics);
  const Json &list = at("/observables"), &limits = at(pointer);
  const FlowKind& flow = flow_kind_of(*this);
  const bool has_moduli = flow.unit == "cycles" && std::count(list.begin(), list.end(), "oscillation") > 0;
  if (!flow.has_whole_cycles && !has_moduli) return duration;
  if (const double cycles = limits.value("cycles", 0.0); cycles != std::floor(cycles)) {
    refuse(pointer + "/cycles", fmt::format("must be a whole number with {}",
                                            flow.has_whole_cycles ? flow.key : "the observable oscillation"));
  }
  duration.period = *physics.flow.period();
  return duration;
}

void Reading::check_window(const Scene& scene, double begin) const {
  const double end = begin + time_of(scene.production, scene, begin);
  const FlowKind& flow = flow_kind_of(*this);
  if (std::isinf(end)) {
    refuse("/duration", fmt::format("would never end: the flow of {} does not make this strain", flow.key));
  }
  const double strain = end * scene.physics.flow.deformation().mean_rate();
  if (strain > flow.largest_strain * (1 + 1e-9)) {
    refuse("/duration", fmt::format("must have a Hencky strain of at most {} in all with {}; it has {:.4g}",
                                    flow.largest_strain, flow.key, strain));
  }
}

// The method, and the default of the guard that follows from it. Without lubrication explicit steps are bound
// by contacts and drag alone, and cheaper.
void fill_method_and_guard(Json& document) {
  Json& integrator = document["integrator"];
  if (!integrator.contains("method")) {
    integrator["method"] = document.contains("lubrication") ? "implicit" : "explicit";
  }
  Json& guard = document["guard"];
  if (!guard.contains("largest_displacement")) {
    guard["largest_displacement"] = integrator["method"] == "implicit" ? 0.3 : 0.05;
  }
}

}  // namespace

std::string lacking_equilibrium(const Physics& physics) {
  if (physics.contact && physics.contact->friction > 0) {
    return "/contact/friction > 0: friction leads to no equilibrium of known probabilities";
  }
  if (physics.contact && physics.contact->normal_damping > 0) {
    return "/contact/normal_damping > 0: what it dissipates no noise gives back";
  }
  if (physics.lubrication && physics.lubrication->form == LubricationParameters::Form::mari) {
    return "/lubrication/form mari: its stress is not that of the forces alone";
  }
  return "";
}

double time_of(const Duration& duration, const Scene& scene, double from) {
  const Physics& physics = scene.physics;
  double time = std::min(duration.time, physics.flow.deformation().time_of(duration.strain, from));
  if (physics.thermal_energy > 0) {
    const double a = scene.particles.reference_radius;
    time = std::min(time, duration.brownian_times * physics.viscosity * a * a * a / physics.thermal_energy);
  }
  time = std::max(time, duration.least_time);
  // What is a whole number of cycles must not gain one by rounding.
  return duration.period > 0 ? std::ceil(time / duration.period * (1 - 1e-12)) * duration.period : time;
}

Vector3 box_lengths(const Scene& scene, double cube_edge) {
  if (!scene.height) return {cube_edge, cube_edge, cube_edge};
  const double width = cube_edge * std::sqrt(cube_edge / *scene.height);
  return {width, *scene.height, width};
}

Duration read_duration(const SceneDocument& document, const std::string& pointer, const Physics& physics) {
  return Reading(document).duration(pointer, physics);
}

Scene read_without_observables(const Json& document, const std::string& file) {
  Scene scene;
  scene.document = document;
  const Json& filled = scene.document;
  const Reading reading(filled, file);
  fill_method_and_guard(scene.document);

  scene.particles = reading.particles();
  scene.volume_fraction = reading.volume_fraction(scene.particles);
  if (filled.contains("box")) scene.height = filled["box"]["height"].get<double>();
  scene.physics = reading.physics();
  reading.check_lubrication(scene.particles, scene.physics);
  set_flow(reading, scene.particles, scene.volume_fraction, scene.physics);

  const Json& integrator = filled["integrator"];
  if (integrator["method"] == "implicit") scene.method = Method::implicit_steps;
  const bool noise = scene.physics.thermal_energy > 0;
  scene.solver_tolerance =
      integrator.value("tolerance", noise ? usual_tolerance_with_noise : usual_tolerance);
  if (integrator.contains("tolerance") && scene.method != Method::implicit_steps) {
    throw InputError(file, "/integrator/tolerance", shortened(integrator["tolerance"]),
                     "must be left out unless /integrator/method is \"implicit\"");
  }
  const Json& timestep = filled["integrator"]["timestep"];
  if (timestep.is_number()) scene.timestep = timestep.get<double>();
  scene.equilibration = reading.phase("/duration/equilibration", scene.physics);
  scene.production = reading.phase("/duration/production", scene.physics);
  const double begin = time_of(scene.equilibration, scene);
  scene.physics.flow.measure_from(begin);
  reading.check_window(scene, begin);
  scene.guard = {filled["guard"]["largest_overlap"].get<double>(),
                 filled["guard"]["largest_displacement"].get<double>(),
                 filled["guard"]["energy_imbalance"].get<double>(),
                 filled["guard"]["half_step_difference"].get<double>()};
  scene.start = reading.start();
  scene.final_checkpoint = filled.value(Json::json_pointer("/files/final_checkpoint"), false);
  scene.final_configuration = filled.value(Json::json_pointer("/files/final_configuration"), false);
  return scene;
}

std::vector<std::string> blocks_of_physics() {
  std::vector<std::string> names = {"fluid", "flow"};
  for (const LawBlock& law : law_blocks) names.emplace_back(law.name);
  return names;
}

Physics read_physics(const Json& document, const std::string& file, const std::string& pointer) {
  if (!document.is_object()) throw InputError(file, pointer, shortened(document), "must be an object");
  const std::vector<std::string> blocks = blocks_of_physics();
  static const KeyTable keys = scene_keys_with("");
  Json filled = Json::object();
  for (const auto& [name, block] : document.items()) {
    if (std::find(blocks.begin(), blocks.end(), name) == blocks.end()) {
      throw InputError(file, pointer + '/' + name, "unknown key",
                       fmt::format("allowed keys: {}", fmt::join(blocks, ", ")));
    }
    try {
      filled[name] = keys.validate(block, "", '/' + name);
    } catch (const InputError& error) {
      throw error.within(file, pointer + '/' + name);
    }
  }
  if (!filled.contains("fluid")) throw InputError(file, pointer + "/fluid", "missing", "must be an object");
  try {
    const Reading reading(filled, "");
    Physics physics = reading.physics();
    physics.flow = read_flow({.scene = reading,
                              .shear_rate = reading.number_or("/flow/shear_rate", 0),
                              .viscosity = physics.viscosity});
    if (physics.flow.deformation().at_stress() != nullptr) {
      reading.refuse(flow_kind_of(reading).key,
                     "must be left out: spheres that stand still have a shear rate at most");
    }
    return physics;
  } catch (const InputError& error) {
    throw error.within(file, pointer);
  }
}

namespace {

// Keys, from `begin` of their pointers on, of the flows that a scene has in the place of a shear rate.
std::vector<std::string> flows_without_rate(std::size_t begin) {
  std::vector<std::string> keys;
  for (const FlowKind& kind : flow_kinds()) {
    if (kind.beside.empty()) keys.push_back(kind.key.substr(begin));
  }
  return keys;
}

// Sets the temperature and returns the shear rate: of all pairs with rate / kT = Pe / (6 pi eta a^3) within
// the limits the one with the larger values.
double rate_from_peclet(const SceneDocument& scene, double radius, Physics& physics) {
  for (const char* pointer : {"/flow/shear_rate", "/fluid/thermal_energy"}) {
    if (scene.has(pointer)) scene.refuse(pointer, "must be left out together with /peclet, which sets it");
  }
  const double peclet = scene.number("/peclet");
  const double scale = 6 * std::numbers::pi * physics.viscosity * radius * radius * radius;
  double rate = scene.number("/limits/shear_rate");
  const double largest_energy = scene.number("/limits/thermal_energy");
  const double rate_at_largest_energy = peclet * largest_energy / scale;
  if (rate_at_largest_energy <= rate) {
    rate = rate_at_largest_energy;
    physics.thermal_energy = largest_energy;
  } else {
    physics.thermal_energy = scale * rate / peclet;
  }
  const auto is_usable = [](double value) { return std::isnormal(value) && value > 0; };
  if (!is_usable(rate) || !is_usable(physics.thermal_energy)) {
    scene.refuse("/peclet", "leaves no shear rate and thermal energy above 0 within /limits");
  }
  return rate;
}

}  // namespace

std::string flow_keys() {
  std::string keys = fmt::format(R"(
/fluid | object | The solvent.
/fluid/viscosity | number > 0; in mass / (length time); named viscosity of the fluid, η | Viscosity eta of the
    solvent.
/fluid/thermal_energy? | number >= 0; in energy; named thermal energy, k_B T | k_B T; absent (or 0): no
    Brownian motion. Not together with peclet.
/flow? | object | The streaming flow (rate y, 0, 0), and waves in it. A scene has flow.shear_rate, flow.{} or
    peclet.
)",
                                 fmt::join(flows_without_rate(std::string("/flow/").size()), ", flow."));
  for (const FlowKind& kind : flow_kinds()) keys += kind.keys;
  return keys + wave_keys + R"(
/peclet? | number > 0; named Péclet number, Pe | Pe = 6 pi eta a^3 rate / k_B T, in place of shear_rate and
    thermal_energy; needs limits.
/limits | object; if peclet | With peclet: the largest rate and temperature that Pe allows are used.
/limits/shear_rate | number > 0; in 1 / time | Shear rate that is not exceeded.
/limits/thermal_energy | number > 0; in energy | k_B T that is not exceeded.
)";
}

void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics) {
  const FlowKind& flow = flow_kind_of(scene);
  for (const char* pointer : {"/box", "/start"}) {
    if (flow.own_cell.empty() || !scene.has(pointer)) continue;
    scene.refuse(pointer, fmt::format("must be left out with {}, whose cell is {}", flow.key, flow.own_cell));
  }
  double rate = scene.number_or("/flow/shear_rate", 0);
  if (scene.has("/peclet")) rate = rate_from_peclet(scene, particles.reference_radius, physics);
  physics.flow = read_flow({scene, rate, physics.viscosity, physics.thermal_energy, volume_fraction});
  if (!scene.has(flow.key) && !scene.has("/peclet")) {
    scene.miss(flow.key, fmt::format("must be a number >= 0, or {} or /peclet with /limits must be given",
                                     fmt::join(flows_without_rate(0), ", ")));
  }
}

// Every key of a scene: the one list behind validation, schema/scene.schema.json and the manual's page.

namespace {

// {0}, {1}: rows of the durations, {2}: of the observables.
constexpr const char* run_rows = R"(
/integrator | object; default {{}} | How the equations of motion are solved.
/integrator/method? | one of explicit, implicit | explicit: velocity Verlet; implicit: steps that solve for
    the velocities. Unless given, implicit with lubrication and explicit without.
/integrator/timestep | number > 0 or one of auto; in time; default "auto" | Time step; auto: half of the
    largest stable explicit one, or the implicit one whose error has been measured, and not more than a 32nd
    of the production window. An oscillation has a whole number of steps, 128 at least: the step is shortened
    to that.
/integrator/tolerance? | number > 0 and <= 0.005 | Residual of the equations of an implicit step, relative to
    the motion, in the energy norm; unless given 0.002, with noise 0.004.
/duration | object | How long a realisation runs.
{0}{1}
/observables | array of 1 or more; default ["stress"] | What is measured.
{2}
/files? | object | Files that a realisation leaves beside its result; absent: none.
/files/final_configuration | true or false; default false | final.xyz: cell, centres, radii, velocities and
    spins at the end of a completed realisation, as extended XYZ.
/files/final_checkpoint? | true or false | final.checkpoint: all that a completed realisation needs to go on,
    with `peclet-engine run --extend`.
/guard | object; default {{}} | Limits that end a realisation as failed, or flag its result.
/guard/largest_overlap | number > 0; default 0.05 | Overlap over the smaller radius of the pair.
/guard/largest_displacement? | number > 0 | Displacement in one step, or in the smallest part of a divided
    implicit one, relative to rate y, over the smallest radius; 0.05 with explicit and 0.3 with implicit steps
    unless given.
/guard/energy_imbalance | number > 0; default 0.3 | Energy that the finite step makes over the work of the
    flow; beyond it the result has the warning timestep.
/guard/half_step_difference | number > 0; default 0.03 | Relative difference of the stress between steps and
    half steps, on samples; beyond it the result has the warning timestep.
)";

}  // namespace

KeyTable scene_keys_with(const std::string& keys_of_observables) {
  std::string all = particle_keys() + flow_keys();
  for (const LawBlock& law : law_blocks) all += law.keys;
  all += start_keys;
  all += fmt::format(
      run_rows,
      duration_keys("/duration/equilibration", ">= 0", "Before anything is measured; a limit of 0 skips it."),
      duration_keys("/duration/production", "> 0", "The window of all means."), keys_of_observables);
  return KeyTable("Scene of a peclet simulation", all);
}

}  // namespace peclet::engine
