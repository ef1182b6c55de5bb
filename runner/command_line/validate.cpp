#include "runner/command_line/validate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <vector>

#include "contract/errors.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/text_table.h"
#include "runner/engines/scene_check.h"

namespace peclet::runner {
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
  for (const char* const title : {"particles", "timestep", "limited by", "steps"}) table.add_column(title);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const SceneAnswer& answer = answers[i];
    std::vector<std::string> cells = points.cells(i);
    for (const Derived& column : columns) cells.push_back(cell(answer.derived, column.key));
    cells.push_back(fmt::format("{}", answer.particles));
    cells.push_back(answer.timestep ? rough(*answer.timestep) : "-");
    cells.push_back(answer.timestep_limit.empty() ? "-" : answer.timestep_limit);
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
                      {"timestep_limit", answers[i].timestep_limit},
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
