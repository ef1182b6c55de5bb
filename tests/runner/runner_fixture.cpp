#include "tests/runner/runner_fixture.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "contract/sha256.h"

namespace peclet::runner {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "peclet-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // the system removes what is left among temporary files
  std::filesystem::remove_all(path_, ignored);
}

Campaign plain_campaign(int points, int minimum, int maximum, double tolerance) {
  Campaign campaign;
  campaign.name = "plain";
  campaign.target = {"relative_viscosity", tolerance, 0.95};
  campaign.minimum_realisations = minimum;
  campaign.maximum_realisations = maximum;
  campaign.document = {{"name", "plain"}, {"tolerance", tolerance}, {"maximum", maximum}};
  for (int point = 0; point < points; ++point) {
    const Json scene{{"point", point}};
    campaign.points.push_back(
        {sha256(canonical_json(scene)), scene, {{"/point", point}}, "point=" + std::to_string(point)});
  }
  return campaign;
}

Json plain_engine(const std::string& identity) {
  return {{"version", "1.0.0"},
          {"instruction_set", "none"},
          {"binary_sha256", sha256(identity)},
          {"cpu", "none"}};
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string noise(std::size_t size, std::uint32_t start) {
  std::string letters;
  std::uint32_t state = start;
  for (std::size_t i = 0; i < size; ++i) {
    state = state * 1664525U + 1013904223U;
    letters += static_cast<char>('0' + (state >> 26));
  }
  return letters;
}

Json plain_result(const std::string& point, int seed, double viscosity, const std::string& identity) {
  return {{"schema_version", 1},
          {"point", point},
          {"seed", seed},
          {"ending", {{"cause", "completed"}, {"step", 100}, {"message", ""}, {"state", nullptr}}},
          {"method", "explicit"},
          {"timestep", 0.001},
          {"steps", {{"equilibration", 20}, {"production", 80}}},
          {"strain", {{"equilibration", 0.2}, {"production", 0.8}}},
          {"time", {{"equilibration", 0.02}, {"production", 0.08}}},
          {"derived", Json::object()},
          {"warnings", Json::array()},
          {"units", "scene"},
          {"mean",
           {{"relative_viscosity", viscosity},
            {"pressure", 2 * viscosity},
            {"control_variates", {{"brownian_pairwise", 0.25}}}}},
          {"blocks",
           {{"relative_viscosity", std::vector<double>(32, viscosity)},
            {"control_variates", {{"brownian_pairwise", std::vector<double>(32, 0.25)}}}}},
          {"statistical_inefficiency", 1.5},
          {"largest_overlap", 0.001},
          {"gate",
           {{"largest_stability_share", 0.4},
            {"energy_imbalance", 2e-5},
            {"half_step_difference", 1e-4},
            {"solver", nullptr}}},
          {"cost", {{"cpu_seconds", 2.0}, {"wall_seconds", 4.0}}},
          {"final_state_sha256", sha256(std::to_string(seed))},
          {"engine", plain_engine(identity)}};
}

Json described_ratio(const Json& values) {
  return {{"symbol", "g(r)"},       {"unit", "1"},
          {"estimator", "ratio"},   {"numerator", "counts"},
          {"denominator", "ideal"}, {"axes", {{{"name", "r"}, {"unit", "radius"}, {"values", values}}}}};
}

}  // namespace peclet::runner
