#include "engine/flow/flow_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/flow/controlled_shear.h"
#include "engine/flow/extension.h"
#include "engine/flow/segments.h"
#include "engine/flow/shear.h"
#include "engine/flow/waves.h"

namespace peclet::engine {

const std::vector<FlowKind>& flow_kinds() {
  static const std::vector<FlowKind> all = {
      steady_shear_flow(),       oscillation_flow(), cross_shear_flow(), planar_extension_flow(),
      uniaxial_extension_flow(), segments_flow(),    stress_flow()};
  return all;
}

std::string flows_with(const std::string& unit) {
  std::vector<std::string> keys;
  for (const FlowKind& kind : flow_kinds()) {
    if (kind.unit == unit) keys.push_back(kind.key);
  }
  return fmt::format("{}", fmt::join(keys, " or "));
}

const FlowKind& flow_kind_of(const SceneDocument& scene) {
  const std::vector<FlowKind>& all = flow_kinds();
  const auto other =
      std::find_if(all.begin() + 1, all.end(), [&](const FlowKind& kind) { return scene.has(kind.key); });
  const FlowKind& flow = other == all.end() ? all.front() : *other;
  const auto refuse = [&](const std::string& key) {
    if (key == flow.key || !scene.has(key) || std::ranges::count(flow.beside, key) > 0) return;
    scene.refuse(key, "must be left out, because {} is given", flow.key);
  };
  for (const FlowKind& kind : all) refuse(kind.key);
  for (const char* key : {"/flow/waves", "/peclet"}) refuse(key);
  return flow;
}

ImposedFlow read_flow(const FlowSource& source) {
  return ImposedFlow(flow_kind_of(source.scene).read(source), read_waves(source.scene));
}

std::string duration_keys(const std::string& pointer, const std::string& range, const std::string& meaning) {
  return fmt::format(R"(
{0} | object | {1} Ends at the first of its limits; at least one is required.
{0}/strain? | number {2} | Strain: shear rate times time.
{0}/brownian_times? | number {2}; in eta a^3 / k_B T | Time in units of the Brownian time.
{0}/time? | number {2}; in time | Time.
{0}/cycles? | number {2} | Least number of cycles of {3}.
{0}/stress_times? | number {2}; in eta / stress | Time in units of viscosity over {4}.
)",
                     pointer, meaning, range, flows_with("cycles"), flows_with("stress_times"));
}

void check_duration(const SceneDocument& scene, const FlowKind& flow, const std::string& pointer) {
  const Json& limits = scene.at(pointer);
  for (const char* unit : {"cycles", "stress_times"}) {
    if (limits.contains(unit) && flow.unit != unit) {
      scene.refuse(pointer + '/' + unit, "must be left out without {}", flows_with(unit));
    }
  }
  if (limits.contains("strain") && !flow.without_strain.empty()) {
    scene.refuse(pointer + "/strain", "must be left out with {}, {}", flow.key, flow.without_strain);
  }
}

}  // namespace peclet::engine
