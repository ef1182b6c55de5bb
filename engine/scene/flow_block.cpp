#include "engine/scene/flow_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/flow/controlled_shear.h"
#include "engine/flow/oscillatory_shear.h"
#include "engine/flow/planar_extension.h"
#include "engine/flow/segments.h"
#include "engine/flow/waves.h"

namespace peclet::engine {
namespace {

// Each makes a flow by itself.
constexpr const char* whole_flows[] = {"/flow/oscillation", "/flow/extension_rate", "/flow/segments",
                                       "/flow/stress"};

std::shared_ptr<const Deformation> uniform_flow(const SceneDocument& scene, double rate) {
  if (!scene.has("/flow/cross_shear")) return std::make_shared<SteadyShear>(rate);
  if (!(rate > 0)) {
    scene.refuse("/flow/cross_shear",
                 "must be left out unless the shear rate is > 0; /flow/oscillation shears to and fro alone");
  }
  if (scene.has("/flow/waves"))
    scene.refuse("/flow/waves", "must be left out together with /flow/cross_shear");
  return std::make_shared<CrossShear>(rate, scene.number("/flow/cross_shear/amplitude"),
                                      scene.number("/flow/cross_shear/frequency"));
}

// Of this shear rate, with the scene's waves.
ImposedFlow shear(const SceneDocument& scene, double rate) {
  const std::shared_ptr<const Deformation> uniform = uniform_flow(scene, rate);
  if (!scene.has("/flow/waves")) return ImposedFlow(uniform);
  if (!scene.has("/flow/faxen"))
    scene.miss("/flow/faxen", "must be true or false where there are /flow/waves");
  std::vector<Wave> waves;
  for (const Json& wave : scene.at("/flow/waves")) {
    const double sine = wave.at("sine").get<double>(), cosine = wave.at("cosine").get<double>();
    if (sine != 0 || cosine != 0) waves.push_back({wave.at("periods").get<int>(), sine, cosine});
  }
  if (waves.empty()) return ImposedFlow(uniform);
  return ImposedFlow(uniform, std::make_shared<Waves>(std::move(waves), scene.at("/flow/faxen").get<bool>()));
}

Segment read_segment(const SceneDocument& scene, const std::string& pointer) {
  const Json& keys = scene.at(pointer);
  Segment segment;
  segment.first_rate = keys.at("shear_rate").get<double>();
  segment.last_rate = keys.value("final_rate", segment.first_rate);
  if (keys.contains("strain") == keys.contains("time")) {
    scene.refuse(pointer, "must have either strain or time, how long it lasts; only the last one has none");
  }
  if (keys.contains("time")) {
    segment.time = keys.at("time").get<double>();
    return segment;
  }
  if (segment.first_rate == 0 && segment.last_rate == 0) {
    scene.refuse(pointer + "/strain", "must be a time instead where the shear rate is 0");
  }
  segment.time = time_of_segment(segment.first_rate, segment.last_rate, keys.at("strain").get<double>());
  return segment;
}

ImposedFlow segments(const SceneDocument& scene) {
  const std::size_t last = scene.at("/flow/segments").size() - 1;
  std::vector<Segment> all;
  for (std::size_t k = 0; k < last; ++k)
    all.push_back(read_segment(scene, fmt::format("/flow/segments/{}", k)));
  const std::string pointer = fmt::format("/flow/segments/{}", last);
  for (const char* key : {"strain", "time", "final_rate"}) {
    if (scene.at(pointer).contains(key)) {
      scene.refuse(pointer + '/' + key, "must be left out of the last segment, which goes on");
    }
  }
  return ImposedFlow(std::make_shared<Segments>(all, scene.at(pointer).at("shear_rate").get<double>()));
}

// Of all pairs with rate / kT = Pe / (6 pi eta a^3) within the limits, the one with the larger values.
void set_flow_from_peclet(const SceneDocument& scene, double radius, Physics& physics) {
  const double peclet = scene.number("/peclet");
  const double scale = 6 * std::numbers::pi * physics.viscosity * radius * radius * radius;
  const double largest_rate = scene.number("/limits/shear_rate");
  const double largest_energy = scene.number("/limits/thermal_energy");
  const double rate_at_largest_energy = peclet * largest_energy / scale;
  if (rate_at_largest_energy <= largest_rate) {
    physics.flow = shear(scene, rate_at_largest_energy);
    physics.thermal_energy = largest_energy;
  } else {
    physics.flow = shear(scene, largest_rate);
    physics.thermal_energy = scale * largest_rate / peclet;
  }
  const auto is_usable = [](double value) { return std::isnormal(value) && value > 0; };
  if (!is_usable(physics.flow.rate()) || !is_usable(physics.thermal_energy)) {
    scene.refuse("/peclet", "leaves no shear rate and thermal energy above 0 within /limits");
  }
}

// About the rate of spheres without friction: the viscosity of Krieger & Dougherty (1959), (1 - phi /
// phi_m)^-1.6 with phi_m = 0.65. Friction, noise and other forces between spheres add to it.
double estimated_rate(double stress, double viscosity, double volume_fraction) {
  constexpr double densest = 0.6, largest = 0.65, exponent = 1.6;
  return stress / viscosity * std::pow(1 - std::min(volume_fraction, densest) / largest, exponent);
}

ImposedFlow at_stress(const SceneDocument& scene, double volume_fraction, const Physics& physics) {
  if (physics.thermal_energy > 0 && physics.lubrication &&
      physics.lubrication->form == LubricationParameters::Form::mari) {
    scene.refuse("/lubrication/form",
                 "must be another one where a stress acts with noise: its stress is not that of the forces "
                 "alone");
  }
  const double stress = scene.number("/flow/stress");
  return ImposedFlow(
      std::make_shared<ControlledShear>(stress, estimated_rate(stress, physics.viscosity, volume_fraction)));
}

Keys segment_keys() {
  return {
      {.pointer = "/flow/segments",
       .kind = KeyKind::array,
       .meaning = "Shear in the place of shear_rate whose rate changes: a list of segments in time. "
                  "Reversals, stops and ramps are such lists.",
       .minimum_items = 1,
       .maximum_items = 64},
      block("/flow/segments/*", "One segment; the last one goes on and says its rate alone."),
      {.pointer = "/flow/segments/*/shear_rate",
       .kind = KeyKind::number,
       .meaning = "Shear rate, of either sign.",
       .unit = "1 / time",
       .required = true},
      {.pointer = "/flow/segments/*/final_rate",
       .kind = KeyKind::number,
       .meaning = "Shear rate at its end, to which it changes linearly; that of its beginning unless given.",
       .unit = "1 / time"},
      positive("/flow/segments/*/strain", "", "Strain that it makes, summed over both directions."),
      positive("/flow/segments/*/time", "time", "Time that it takes, in the place of strain."),
  };
}

Keys wave_keys() {
  constexpr std::size_t most_waves = 64;
  return {
      {.pointer = "/flow/waves",
       .kind = KeyKind::array,
       .meaning =
           "Waves along y that the flow has besides: u_x = sum of sine sin(k y) + cosine cos(k y) with k "
           "= 2 pi periods / L.",
       .minimum_items = 1,
       .maximum_items = most_waves},
      block("/flow/waves/*", "One wave."),
      {.pointer = "/flow/waves/*/periods",
       .kind = KeyKind::integer,
       .meaning = "Periods of the wave along the edge of the box.",
       .required = true,
       .minimum = 1,
       .maximum = 1000},
      {.pointer = "/flow/waves/*/sine",
       .kind = KeyKind::number,
       .meaning = "Amplitude of the sine.",
       .unit = "length / time",
       .default_value = 0},
      {.pointer = "/flow/waves/*/cosine",
       .kind = KeyKind::number,
       .meaning = "Amplitude of the cosine.",
       .unit = "length / time",
       .default_value = 0},
      {.pointer = "/flow/faxen",
       .kind = KeyKind::boolean,
       .meaning =
           "Whether spheres feel the curvature of the waves: their velocity with the factor 1 - a^2 k^2 / "
           "6, the strain of their stresslet with 1 - a^2 k^2 / 10. Must be given with waves; without them "
           "nothing is curved."},
  };
}

}  // namespace

Keys flow_keys() {
  Keys keys = {
      block("/fluid", "The solvent.", required),
      positive("/fluid/viscosity", "mass / (length time)", "Viscosity eta of the solvent.", required),
      not_negative("/fluid/thermal_energy", "energy",
                   "k_B T; absent (or 0): no Brownian motion. Not together with peclet."),
      block("/flow",
            "The streaming flow (rate y, 0, 0), and waves in it. A scene has flow.shear_rate, "
            "flow.oscillation, flow.extension_rate, flow.segments, flow.stress or peclet."),
      not_negative("/flow/shear_rate", "1 / time", "Shear rate; 0: no mean shear. Not together with peclet."),
      block("/flow/oscillation",
            "Shear to and fro in the place of shear_rate: strain = amplitude sin(frequency t)."),
      positive("/flow/oscillation/amplitude", "", "Largest strain.", required),
      positive("/flow/oscillation/frequency", "1 / time", "Angular frequency, in radians per time.",
               required),
      block("/flow/cross_shear",
            "Shear to and fro across the steady one, u_z = y d/dt [amplitude sin(frequency t)]."),
      positive("/flow/cross_shear/amplitude", "", "Its largest strain.", required),
      positive("/flow/cross_shear/frequency", "1 / time", "Angular frequency, in radians per time.",
               required),
      positive("/flow/extension_rate", "1 / time",
               "Planar extension in the place of shear: (rate x, -rate y, 0). Strains are Hencky strains, "
               "at most 10 in a realisation."),
  };
  const auto append = [&](const Keys& more) { keys.insert(keys.end(), more.begin(), more.end()); };
  append(segment_keys());
  append({
      positive("/flow/stress", "stress",
               "Shear stress that is held in the place of a rate: its mean rate is what is measured."),
      positive(
          "/flow/jammed_viscosity", "",
          "Relative viscosity beyond which a realisation under a stress has jammed; 10000 unless given."),
  });
  append(wave_keys());
  append({
      positive("/peclet", "",
               "Pe = 6 pi eta a^3 rate / k_B T, in place of shear_rate and thermal_energy; needs limits."),
      block("/limits",
            "Of the scene with a given peclet: the largest rate and temperature that Pe allows are used."),
      positive("/limits/shear_rate", "1 / time", "Shear rate that is not exceeded.", required),
      positive("/limits/thermal_energy", "energy", "k_B T that is not exceeded.", required),
  });
  return keys;
}

ImposedFlow read_flow(const SceneDocument& scene) {
  if (scene.has("/flow/jammed_viscosity") && !scene.has("/flow/stress")) {
    scene.refuse("/flow/jammed_viscosity", "must be left out without /flow/stress");
  }
  for (const char* whole : whole_flows) {
    if (!scene.has(whole)) continue;
    for (const char* other : {"/flow/shear_rate", "/flow/waves", "/flow/cross_shear", "/peclet"}) {
      if (scene.has(other)) scene.refuse(other, fmt::format("must be left out together with {}", whole));
    }
    for (const char* other : whole_flows) {
      if (other != whole && scene.has(other)) {
        scene.refuse(other, fmt::format("must be left out together with {}", whole));
      }
    }
  }
  if (scene.has("/flow/oscillation")) {
    return ImposedFlow(std::make_shared<OscillatoryShear>(scene.number("/flow/oscillation/amplitude"),
                                                          scene.number("/flow/oscillation/frequency")));
  }
  if (scene.has("/flow/segments")) return segments(scene);
  if (scene.has("/flow/extension_rate")) {
    return ImposedFlow(std::make_shared<PlanarExtension>(scene.number("/flow/extension_rate")));
  }
  if (scene.has("/peclet") || scene.has("/flow/stress")) return {};
  return shear(scene, scene.number_or("/flow/shear_rate", 0));
}

void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics) {
  if (scene.has("/flow/extension_rate")) {
    for (const char* pointer : {"/box", "/start"}) {
      if (scene.has(pointer))
        scene.refuse(pointer, "must be left out with /flow/extension_rate, whose cell is a turned cube");
    }
  }
  if (scene.has("/peclet")) {
    for (const char* pointer : {"/flow/shear_rate", "/fluid/thermal_energy"}) {
      if (scene.has(pointer)) scene.refuse(pointer, "must be left out together with /peclet, which sets it");
    }
    if (!scene.has("/limits")) {
      scene.miss("/limits", "must be an object with shear_rate and thermal_energy, because /peclet is given");
    }
    set_flow_from_peclet(scene, particles.reference_radius, physics);
    return;
  }
  if (scene.has("/limits")) scene.refuse("/limits", "must be left out without /peclet");
  if (scene.has("/flow/stress")) physics.flow = at_stress(scene, volume_fraction, physics);
  const bool has_whole =
      std::ranges::any_of(whole_flows, [&](const char* pointer) { return scene.has(pointer); });
  if (!scene.has("/flow/shear_rate") && !has_whole) {
    scene.miss("/flow/shear_rate", fmt::format("must be a number >= 0, or {} or /peclet with /limits must be "
                                               "given",
                                               fmt::join(whole_flows, ", ")));
  }
}

std::optional<std::string> fault_of_observable(const SceneDocument& scene, const std::string& name) {
  const auto fault = [&](const char* flow) {
    return fmt::format("must not list {} with {}, whose flow it does not know", name, flow);
  };
  const auto is_one_of = [&](std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const char* known) { return name == known; });
  };
  if (scene.has("/flow/stress") &&
      !is_one_of({"pair_distribution", "contact_network", "fabric", "trajectory"})) {
    return fault("/flow/stress");
  }
  if (scene.has("/flow/extension_rate") &&
      !is_one_of({"contact_network", "fabric", "transient", "trajectory"})) {
    return fault("/flow/extension_rate");
  }
  if (scene.has("/flow/cross_shear") && name == "mean_squared_displacement")
    return fault("/flow/cross_shear");
  const bool swings = scene.has("/flow/oscillation") || scene.has("/flow/cross_shear");
  if (name == "oscillation" && !swings) {
    return "must not list oscillation without /flow/oscillation or /flow/cross_shear";
  }
  if (name == "transient" && swings) return fault("a flow that comes and goes");
  const bool is_mari = scene.has("/lubrication/form") && scene.at("/lubrication/form") == "mari";
  if (is_mari && is_one_of({"oscillation", "transient"})) {
    return fmt::format(
        "must not list {} with /lubrication/form mari: its stress is not that of the forces "
        "alone",
        name);
  }
  return std::nullopt;
}

void check_duration_of_flow(const SceneDocument& scene, const std::string& pointer) {
  const Json& limits = scene.at(pointer);
  const auto refuse = [&](const char* limit, const std::string& allowed) {
    if (limits.contains(limit)) scene.refuse(pointer + '/' + limit, allowed);
  };
  if (!scene.has("/flow/oscillation") && !scene.has("/flow/cross_shear")) {
    refuse("cycles", "must be left out without /flow/oscillation or /flow/cross_shear");
  }
  if (scene.has("/flow/oscillation")) {
    refuse("strain", "must be left out with /flow/oscillation, whose strain comes and goes; cycles are even");
  }
  if (scene.has("/flow/stress")) {
    refuse("strain",
           "must be left out with /flow/stress, whose strain is not known beforehand; stress_times are the "
           "same for all stresses");
  } else {
    refuse("stress_times", "must be left out without /flow/stress");
  }
}

}  // namespace peclet::engine
