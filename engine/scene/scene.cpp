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

namespace peclet::engine {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

constexpr const char* start_keys = R"(
/start? | object | Where the spheres begin: at a frame of a file with the same spheres and the same cell,
    which may be sheared; absent: in a random packing. Strain and time count from there.
/start/file | string | Absolute path of a trajectory (GSD), a final configuration (extended XYZ), or a file of
    LAMMPS or LF_DEM, at which every seed begins. A campaign needs noise with it: otherwise seeds do not differ.
/start/list | string; instead of file | Absolute path of a list of such files, as sha256sum writes it: seed k
    begins at the file of line k + 1. Seeds beyond the list fail.
/start/sha256 | hash | SHA-256 of the file or the list, as sha256sum prints it. It belongs to the point; a
    file with other content is refused.
/start/frame | integer >= -1000000000 and <= 1000000000; default -1 | Frame of the file, from 0; -1 is the
    last one, -2 the one before it.
/seeds_in_common? | true or false | true: seed k has the same random packing and the same noise in every scene
    that says so, and the difference between two scenes has a smaller error than either. Laws, jamming points
    and bands of curves then claim too much, because they take points as independent. Otherwise the random
    numbers follow from the seed and the scene, without its durations, observables and files.
)";

// Requires the block start.
Start read_start(const SceneDocument& scene) {
  Start start;
  start.is_list = scene.has("/start/list");
  start.path = scene.at(start.pointer()).get<std::string>();
  start.sha256 = scene.at("/start/sha256").get<std::string>();
  start.frame = scene.at("/start/frame").get<std::int64_t>();
  if (!start.path.starts_with('/')) {
    scene.refuse(start.pointer(), "must be an absolute path: engines work in other folders");
  }
  return start;
}

// Reads the fluid and the laws of pairs.
Physics read_laws(const SceneDocument& scene) {
  Physics physics;
  physics.viscosity = scene.number("/fluid/viscosity");
  physics.thermal_energy = scene.number_or("/fluid/thermal_energy", 0);
  for (const LawBlock& law : law_blocks) {
    if (scene.has("/" + std::string(law.name))) law.read(scene, physics);
  }
  return physics;
}

void check_lubrication(const SceneDocument& scene, const Particles& particles, const Physics& physics) {
  if (!physics.lubrication) return;
  const auto by_radius = [](const Species& a, const Species& b) { return a.radius < b.radius; };
  const double smallest = std::ranges::min_element(particles.species, by_radius)->radius;
  if (const std::optional<std::string> fault = fault_of_outer_distance(*physics.lubrication, smallest)) {
    scene.refuse("/lubrication/outer_distance", "{}", *fault);
  }
}

// Reads a phase of a realisation. It lasts whole cycles if the flow or the observable oscillation needs them.
Duration read_phase(const SceneDocument& scene, const std::string& pointer, const Physics& physics) {
  Duration duration = read_duration(scene, pointer, physics);
  const Json &list = scene.at("/observables"), &limits = scene.at(pointer);
  const FlowKind& flow = flow_kind_of(scene);
  const bool has_moduli = flow.unit == "cycles" && std::count(list.begin(), list.end(), "oscillation") > 0;
  if (!flow.has_whole_cycles && !has_moduli) return duration;
  if (const double cycles = limits.value("cycles", 0.0); cycles != std::floor(cycles)) {
    scene.refuse(pointer + "/cycles", "must be a whole number with {}",
                 flow.has_whole_cycles ? flow.key : "the observable oscillation");
  }
  duration.period = *physics.flow.period();
  return duration;
}

// Throws InputError if the production window, from `begin` on, never ends or strains the cell too far.
void check_window(const SceneDocument& document, const Scene& scene, double begin) {
  const double end = begin + time_of(scene.production, scene, begin);
  const FlowKind& flow = flow_kind_of(document);
  if (std::isinf(end)) {
    document.refuse("/duration", "would never end: the flow of {} does not make this strain", flow.key);
  }
  const double strain = end * scene.physics.flow.deformation().mean_rate();
  if (strain > flow.largest_strain * (1 + 1e-9)) {
    document.refuse("/duration", "must have a Hencky strain of at most {} in all with {}; it has {:.4g}",
                    flow.largest_strain, flow.key, strain);
  }
}

// Sets the defaults of the method and of the guard. Without lubrication explicit steps are cheaper, because
// only contacts and drag limit them.
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

// Returns the keys of the flows that replace a shear rate, without the first `begin` characters.
std::vector<std::string> flows_without_rate(std::size_t begin) {
  std::vector<std::string> keys;
  for (const FlowKind& kind : flow_kinds()) {
    if (kind.beside.empty()) keys.push_back(kind.key.substr(begin));
  }
  return keys;
}

// Sets the temperature and returns the shear rate: the largest within the limits that have rate / kT = Pe /
// (6 pi eta a^3). At Pe = 0 the rate is 0.
double rate_from_peclet(const SceneDocument& scene, double radius, Physics& physics) {
  for (const char* pointer : {"/flow/shear_rate", "/fluid/thermal_energy"}) {
    if (scene.has(pointer)) scene.refuse(pointer, "must be left out, because /peclet sets it");
  }
  const double peclet = scene.number("/peclet");
  const double scale = 6 * std::numbers::pi * physics.viscosity * radius * radius * radius;
  double rate = scene.number("/limits/shear_rate");
  const double largest_energy = scene.number("/limits/thermal_energy");
  if (peclet == 0) {
    physics.thermal_energy = largest_energy;
    return 0;
  }
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

// {0}, {1}: rows of the durations; {2}: rows of the observables.
constexpr const char* run_rows = R"(
/integrator | object; default {{}} | How the equations of motion are solved.
/integrator/method? | one of explicit, implicit | explicit: velocity Verlet; implicit: steps that solve for
    the velocities. Unless given, implicit with lubrication and explicit without.
/integrator/timestep | number > 0 or one of auto; in time; default "auto" | Time step; auto: half of the
    largest stable explicit one, or the implicit one whose error has been measured, and not more than a 32nd
    of the production window. A cycle of an oscillation has a whole number of steps, at least 128: the step is
    shortened to fit.
/integrator/tolerance? | number > 0 and <= 0.005 | Residual of the equations of an implicit step, relative to
    the motion, in the energy norm; unless given 0.002, with noise 0.004.
/duration | object | How long a realisation runs.
{0}{1}
/observables | array of 1 or more; default ["stress"] | What is measured.
{2}
/files? | object | Files that a realisation leaves beside its result; absent: none.
/files/final_configuration | true or false; default false | final.xyz: cell, centres, radii, velocities and
    spins at the end of a completed realisation, as extended XYZ.
/files/final_checkpoint? | true or false | final.checkpoint: the state from which `peclet-engine run --extend`
    continues a completed realisation.
/guard | object; default {{}} | Limits that end a realisation as failed, or flag its result.
/guard/largest_overlap | number > 0; default 0.05 | Overlap over the smaller radius of the pair.
/guard/largest_displacement? | number > 0 | Displacement in one step, or in the smallest part of a divided
    implicit one, relative to the flow, over the smallest radius; 0.05 with explicit and 0.3 with implicit
    steps unless given.
/guard/energy_imbalance | number > 0; default 0.3 | Energy that steps make because they are finite, over the
    work of the flow; beyond it the result has the warning timestep.
/guard/half_step_difference | number > 0; default 0.03 | Relative difference of the stress between steps and
    half steps, on samples; beyond it the result has the warning timestep.
)";

}  // namespace

std::string lacking_equilibrium(const Physics& physics) {
  if (physics.contact && physics.contact->friction > 0) {
    return "/contact/friction > 0: friction leads to no equilibrium of known probabilities: set it to 0";
  }
  if (physics.contact && physics.contact->normal_damping > 0) {
    return "/contact/normal_damping > 0: no noise balances its dissipation";
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
  // Rounding must not add a cycle to a whole number of cycles.
  return duration.period > 0 ? std::ceil(time / duration.period * (1 - 1e-12)) * duration.period : time;
}

Vector3 box_lengths(const Scene& scene, double cube_edge) {
  if (!scene.height) return {cube_edge, cube_edge, cube_edge};
  const double width = cube_edge * std::sqrt(cube_edge / *scene.height);
  return {width, *scene.height, width};
}

Duration read_duration(const SceneDocument& document, const std::string& pointer, const Physics& physics) {
  const Json& limits = document.at(pointer);
  if (limits.empty())
    document.refuse(pointer, "must have at least one of strain, brownian_times, time, cycles, stress_times");
  check_duration(document, flow_kind_of(document), pointer);
  Duration duration;
  if (physics.flow.rate() > 0) duration.strain = limits.value("strain", unlimited);
  if (physics.thermal_energy > 0) duration.brownian_times = limits.value("brownian_times", unlimited);
  duration.time = limits.value("time", unlimited);
  if (limits.contains("stress_times")) {
    const double unit = physics.flow.deformation().at_stress()->stress_time();
    duration.time = std::min(duration.time, limits.at("stress_times").get<double>() * unit);
  }
  for (const auto& [name, limit] : limits.items()) {
    // A limit of 0 ends the duration before it starts, whatever the flow.
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
    document.refuse(
        pointer,
        "would never end: strain needs a shear rate > 0, brownian_times a thermal energy > 0; give one of "
        "them "
        "that is reached, or time");
  }
  return duration;
}

Scene read_without_observables(const Json& document, const std::string& file) {
  Scene scene;
  scene.document = document;
  const Json& filled = scene.document;
  const SceneDocument reading(filled, file);
  fill_method_and_guard(scene.document);

  scene.particles = read_particles(reading);
  scene.volume_fraction = read_volume_fraction(reading, scene.particles);
  if (filled.contains("box")) scene.height = filled["box"]["height"].get<double>();
  scene.physics = read_laws(reading);
  check_lubrication(reading, scene.particles, scene.physics);
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
  scene.equilibration = read_phase(reading, "/duration/equilibration", scene.physics);
  scene.production = read_phase(reading, "/duration/production", scene.physics);
  const double begin = time_of(scene.equilibration, scene);
  scene.physics.flow.measure_from(begin);
  check_window(reading, scene, begin);
  scene.guard = {filled["guard"]["largest_overlap"].get<double>(),
                 filled["guard"]["largest_displacement"].get<double>(),
                 filled["guard"]["energy_imbalance"].get<double>(),
                 filled["guard"]["half_step_difference"].get<double>()};
  if (reading.has("/start")) scene.start = read_start(reading);
  scene.seeds_in_common = filled.value("seeds_in_common", false);
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
    const SceneDocument reading(filled, "");
    Physics physics = read_laws(reading);
    physics.flow = read_flow({.scene = reading,
                              .shear_rate = reading.number_or("/flow/shear_rate", 0),
                              .viscosity = physics.viscosity});
    if (physics.flow.deformation().at_stress() != nullptr) {
      reading.refuse(flow_kind_of(reading).key,
                     "must be left out: a single configuration has a rate, not a stress");
    }
    return physics;
  } catch (const InputError& error) {
    throw error.within(file, pointer);
  }
}

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
/peclet? | number >= 0; named Péclet number, Pe | Pe = 6 pi eta a^3 rate / k_B T, in place of shear_rate and
    thermal_energy; needs limits. 0: a fluid at rest.
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
    scene.refuse(pointer, "must be left out with {}, whose cell is {}", flow.key, flow.own_cell);
  }
  double rate = scene.number_or("/flow/shear_rate", 0);
  if (scene.has("/peclet")) rate = rate_from_peclet(scene, particles.reference_radius, physics);
  physics.flow = read_flow({scene, rate, physics.viscosity, physics.thermal_energy, volume_fraction});
  if (!scene.has(flow.key) && !scene.has("/peclet")) {
    scene.miss(flow.key, "must be a number >= 0, or {} or /peclet with /limits must be given",
               fmt::join(flows_without_rate(0), ", "));
  }
}

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
