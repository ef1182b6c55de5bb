// What a scene means: the rules that bind several keys, and the values that follow from others.
#include "engine/scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "engine/flow/controlled_shear.h"
#include "engine/flow/flows.h"
#include "engine/scene/flow_block.h"
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
  fill_lubrication(scene.document);

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
  static const KeyTable keys = scene_keys_with({});
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
  fill_lubrication(filled);
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

}  // namespace peclet::engine
