#include "engine/scene/flow_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "engine/flow/flows.h"
#include "engine/flow/waves.h"

namespace peclet::engine {
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
  if (!scene.has("/limits")) {
    scene.miss("/limits", "must be an object with shear_rate and thermal_energy, because /peclet is given");
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

Keys flow_keys() {
  Keys keys = {
      block("/fluid", "The solvent.", required),
      named(positive("/fluid/viscosity", "mass / (length time)", "Viscosity eta of the solvent.", required),
            "viscosity of the fluid", "η"),
      named(not_negative("/fluid/thermal_energy", "energy",
                         "k_B T; absent (or 0): no Brownian motion. Not together with peclet."),
            "thermal energy", "k_B T"),
      block("/flow", fmt::format("The streaming flow (rate y, 0, 0), and waves in it. A scene has "
                                 "flow.shear_rate, flow.{} or peclet.",
                                 fmt::join(flows_without_rate(std::string("/flow/").size()), ", flow."))),
  };
  const auto append = [&](const Keys& more) { keys.insert(keys.end(), more.begin(), more.end()); };
  for (const FlowKind& kind : flow_kinds()) append(kind.keys);
  append(wave_keys());
  append({
      named(positive(
                "/peclet", "",
                "Pe = 6 pi eta a^3 rate / k_B T, in place of shear_rate and thermal_energy; needs limits."),
            "Péclet number", "Pe"),
      block("/limits",
            "Of the scene with a given peclet: the largest rate and temperature that Pe allows are used."),
      positive("/limits/shear_rate", "1 / time", "Shear rate that is not exceeded.", required),
      positive("/limits/thermal_energy", "energy", "k_B T that is not exceeded.", required),
  });
  return keys;
}

void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics) {
  const FlowKind& flow = flow_kind_of(scene);
  for (const char* pointer : {"/box", "/start"}) {
    if (flow.own_cell.empty() || !scene.has(pointer)) continue;
    scene.refuse(pointer, fmt::format("must be left out with {}, whose cell is {}", flow.key, flow.own_cell));
  }
  double rate = scene.number_or("/flow/shear_rate", 0);
  if (scene.has("/peclet")) {
    rate = rate_from_peclet(scene, particles.reference_radius, physics);
  } else if (scene.has("/limits")) {
    scene.refuse("/limits", "must be left out without /peclet");
  }
  physics.flow = read_flow({scene, rate, physics.viscosity, physics.thermal_energy, volume_fraction});
  if (!scene.has(flow.key) && !scene.has("/peclet")) {
    scene.miss(flow.key, fmt::format("must be a number >= 0, or {} or /peclet with /limits must be given",
                                     fmt::join(flows_without_rate(0), ", ")));
  }
}

}  // namespace peclet::engine
