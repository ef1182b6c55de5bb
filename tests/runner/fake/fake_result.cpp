#include "tests/runner/fake/fake_result.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "contract/sha256.h"
#include "tests/runner/fake/fake_faults.h"

namespace peclet::fake {

Json engine() {
  const char* const name = std::getenv("PECLET_FAKE_IDENTITY");
  return {{"version", "0.0.0"},       {"git_commit", "unknown"},
          {"git_dirty", nullptr},     {"binary_sha256", sha256(name == nullptr ? "fake" : name)},
          {"compiler", "none"},       {"flags", ""},
          {"build_type", "none"},     {"cpu", "none"},
          {"instruction_set", "none"}};
}

Json outcome(const Json& job, const State& state, bool blown_up) {
  // Box and Muller: a normal variate of two uniform ones, the first of which never vanishes.
  const double first = (static_cast<double>(mix(state.value) >> 11) + 1) * 0x1p-53;
  const double second = static_cast<double>(mix(state.value + 1) >> 11) * 0x1p-53;
  const double normal = std::sqrt(-2 * std::log(first)) * std::cos(2 * std::numbers::pi * second);
  const double viscosity = setting("PECLET_FAKE_MEAN", 10) + setting("PECLET_FAKE_DEVIATION", 1) * normal;
  Json result{
      {"schema_version", 1},
      {"point", job.at("point")},
      {"seed", job.at("seed")},
      {"ending", {{"cause", "completed"}, {"step", state.step}, {"message", ""}, {"state", nullptr}}},
      {"method", "explicit"},
      {"timestep", 0.001},
      {"steps", {{"equilibration", 0}, {"production", state.step}}},
      {"strain", {{"equilibration", 0}, {"production", 0.1 * state.step}}},
      {"time", {{"equilibration", 0}, {"production", 0.001 * state.step}}},
      {"derived", Json::object()},
      {"warnings", Json::array()},
      {"units", "scene"},
      {"mean", {{"relative_viscosity", viscosity}, {"control_variates", {{"brownian_pairwise", nullptr}}}}},
      {"blocks", {{"relative_viscosity", std::vector<double>(32, viscosity)}}},
      {"quantities", {{"relative_viscosity", {{"symbol", "eta_r"}, {"unit", "1"}, {"estimator", "mean"}}}}},
      {"statistical_inefficiency", 1},
      {"largest_overlap", 0},
      {"gate", nullptr},
      {"final_state_sha256", sha256(std::to_string(state.value))},
      {"engine", engine()}};
  if (const auto padding = static_cast<std::size_t>(setting("PECLET_FAKE_PADDING", 0)); padding > 0) {
    Json& numbers = result["blocks"]["padding"] = Json::array();
    std::uint64_t noise = state.value;  // five digits, as in a real engine's blocks, and no two alike
    for (std::size_t i = 0; i < padding; ++i) {
      noise = mix(noise);
      numbers.push_back(static_cast<double>(noise % 100'000) * 1e-5);
    }
  }
  if (blown_up) {
    result["ending"] = {
        {"cause", "overlap"}, {"step", state.step}, {"message", "as asked"}, {"state", nullptr}};
    result["mean"] = result["blocks"] = result["quantities"] = nullptr;
  }
  return result;
}

}  // namespace peclet::fake
