#include "runner/command_line/validate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/text_table.h"
#include "runner/engines/scene_check.h"

namespace peclet::runner {
namespace {

// The campaign file that `peclet init` writes; {0} is the name.
constexpr const char* text = R"({{
  "name": "{0}",
  "scene": {{
    "particles": {{
      "count": 100,
      "density": 0.1,
      "species": [
        {{ "radius": 1.0, "volume_share": 0.5 }},
        {{ "radius": 1.4, "volume_share": 0.5 }}
      ]
    }},
    "volume_fraction": 0.4,
    "peclet": 10,
    "limits": {{ "shear_rate": 0.045, "thermal_energy": 0.017 }},
    "fluid": {{ "viscosity": 0.1 }},
    "contact": {{ "normal_stiffness": 1e4, "friction": 0.5 }},
    "lubrication": {{ "form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05 }},
    "duration": {{
      "equilibration": {{ "strain": 1, "brownian_times": 5 }},
      "production": {{ "strain": 2, "brownian_times": 10 }}
    }}
  }},
  "sweep": [
    {{ "set": "/peclet", "values": [10, 100, 1000] }}
  ],
  "target": {{ "observable": "relative_viscosity", "relative_tolerance": 0.05, "confidence": 0.95 }},
  "realisations": {{ "minimum": 10, "maximum": 200 }}
}}
)";

}  // namespace

std::string init_campaign(const InitOptions& options) {
  const std::filesystem::path& file = options.campaign;
  if (file.extension() != ".json") {
    throw InputError(file.string(), "", file.extension().string(), "must end in .json");
  }
  const std::string name = file.stem().string();
  check_campaign_name(name, file.string());
  if (!kind_of(file).empty()) {  // also a dangling link
    throw InputError(file.string(), "", "", "is there already, and is not replaced");
  }
  check_output(file);
  write_durably(file, fmt::format(fmt::runtime(text), name));
  return fmt::format(
      "{0} is written: 100 spheres, three Péclet numbers, to 5 %\n"
      "  peclet validate {1}\n"
      "  peclet run {1}\n",
      file.string(), words_for(file, ""));
}

namespace {

struct Derived {
  std::string key, heading;
};

// Returns a column for each derived number of at least one point: first those that the engine describes, in
// its order, then the others under their own names.
std::vector<Derived> derived_columns(const std::vector<SceneAnswer>& answers) {
  std::set<std::string> present;
  for (const SceneAnswer& answer : answers) {
    for (const auto& [key, value] : answer.derived.items()) {
      if (value.is_number()) present.insert(key);
    }
  }
  std::vector<Derived> columns;
  for (const Json& known : answers.front().words->derived()) {
    const auto text = [&](const char* member) { return known.at(member).get<std::string>(); };
    if (present.erase(text("name")) == 0) continue;
    const std::string heading = !text("symbol").empty() ? text("symbol") : text("words");
    columns.push_back({text("name"), heading.empty() ? text("name") : heading});
  }
  for (const std::string& key : present) columns.push_back({key, key});
  return columns;
}

std::string cell(const Json& derived, const std::string& key) {
  const auto found = derived.find(key);
  return found != derived.end() && found->is_number() ? rough(found->get<double>()) : "-";
}

std::string points_table(const Campaign& campaign, const std::vector<SceneAnswer>& answers) {
  const std::vector<Derived> columns = derived_columns(answers);
  std::vector<std::string> labels;
  for (const StatePoint& point : campaign.points) labels.push_back(point.label);
  const PointColumns points(labels);
  TextTable table;
  points.add_to(table);
  for (const Derived& column : columns) table.add_column(column.heading);
  for (const char* const title : {"particles", "timestep", "steps"}) table.add_column(title);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const SceneAnswer& answer = answers[i];
    std::vector<std::string> cells = points.cells(i);
    for (const Derived& column : columns) cells.push_back(cell(answer.derived, column.key));
    cells.push_back(fmt::format("{}", answer.particles));
    cells.push_back(answer.timestep ? rough(*answer.timestep) : "-");
    cells.push_back(rough(answer.steps));
    table.add_row(cells);
  }
  return table.text();
}

// Returns each warning once, with the points that it concerns.
std::string warnings_text(const Campaign& campaign, const std::vector<SceneAnswer>& answers) {
  std::map<std::string, std::vector<std::string>> labels;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (const std::string& warning : answers[i].warnings)
      labels[warning].push_back(campaign.points[i].label);
  }
  std::string text;
  for (const auto& [warning, of_points] : labels) {
    text += fmt::format("warning: {}: {}\n", fmt::join(of_points, ", "), warning);
  }
  return text.empty() ? text : '\n' + text;
}

Json answers_json(const Campaign& campaign, const std::vector<SceneAnswer>& answers) {
  Json points = Json::array();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    points.push_back({{"label", campaign.points[i].label},
                      {"hash", campaign.points[i].hash},
                      {"settings", campaign.points[i].settings},
                      {"particles", answers[i].particles},
                      {"timestep", answers[i].timestep ? Json(*answers[i].timestep) : Json(nullptr)},
                      {"steps", answers[i].steps},
                      {"derived", answers[i].derived},
                      {"warnings", answers[i].warnings}});
  }
  return {{"schema_version", 1}, {"campaign", campaign.name}, {"points", points}};
}

}  // namespace

std::string validate_campaign(const ValidateOptions& options) {
  const Campaign campaign = read_campaign(options.campaign);
  const std::vector<SceneAnswer> answers =
      check_scenes(campaign, options.campaign, resolve_engine(campaign, options.campaign));
  if (options.json) return answers_json(campaign, answers).dump(2) + '\n';
  return fmt::format("{}: valid; {}, {} seeds each\n\n{}\ntimes in the scene's own units\n{}", campaign.name,
                     counted(campaign.points.size(), "point"),
                     range_text(campaign.minimum_realisations, campaign.maximum_realisations),
                     points_table(campaign, answers), warnings_text(campaign, answers));
}

}  // namespace peclet::runner
