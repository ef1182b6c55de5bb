#include "runner/page/joined_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "contract/errors.h"
#include "runner/page/page_data.h"
#include "runner/page/swept.h"
#include "runner/reports/status.h"

namespace peclet::runner {
namespace {

struct Part {
  std::string name;
  Json page, scenes;  // the document of the campaign, and the scene of each point
};

Part part_of(const NamedCampaign& source) {
  Part part{source.name, page_data(source.database, std::nullopt), Json::array()};
  for (const PointSummary& point : read_status(source.database, std::nullopt).points)
    part.scenes.push_back(point.point.scene);
  return part;
}

// Adds the elements of a list that it does not have yet, told apart by these members.
void add_new(Json& list, const Json& others, const std::vector<const char*>& members) {
  for (const Json& other : others) {
    const auto is_alike = [&](const Json& one) {
      return std::ranges::all_of(members,
                                 [&](const char* member) { return one.at(member) == other.at(member); });
    };
    if (std::ranges::none_of(list, is_alike)) list.push_back(other);
  }
}

// Adds numbers, and those within objects.
void add_numbers(Json& sum, const Json& more) {
  for (const auto& [name, value] : more.items()) {
    if (value.is_object()) {
      add_numbers(sum[name], value);
    } else if (value.is_number()) {
      sum[name] = sum.contains(name) ? sum[name].get<double>() + value.get<double>() : value.get<double>();
    }
  }
}

Json joined_progress(const std::vector<Part>& parts) {
  Json sum = Json::object();
  int check = 0;
  for (const Part& part : parts) {
    add_numbers(sum, part.page.at("progress"));
    check = std::max(check, part.page.at("progress").at("check").get<int>());
  }
  sum.update({{"check", check}, {"seconds_to_go", nullptr}, {"owner", nullptr}, {"workers", nullptr}});
  return sum;
}

Json joined_target(const std::vector<Part>& parts) {
  Json target = parts.front().page.at("target");
  std::string texts = fmt::format("{}: {}", parts.front().name, target.at("text").get<std::string>());
  bool is_same = true;
  for (const Part& part : parts) {
    const Json& own = part.page.at("target");
    for (const char* const member : {"observable", "confidence"}) {
      if (own.at(member) == target.at(member)) continue;
      throw InputError("", "--with", part.name,
                       fmt::format("must have the {} of the first campaign, {}; it has {}", member,
                                   target.at(member).dump(), own.at(member).dump()));
    }
    if (&part == &parts.front()) continue;
    is_same = is_same && own.at("text") == target.at("text");
    texts += fmt::format("; {}: {}", part.name, own.at("text").get<std::string>());
    target["minimum"] = std::min(target["minimum"], own.at("minimum"));
    target["maximum"] = std::max(target["maximum"], own.at("maximum"));
  }
  if (!is_same) target["text"] = texts;
  return target;
}

// Adds the points of a campaign. `quantities` and `parameters` are those of all campaigns.
void add_points(const Part& part, const Json& quantities, const Json& parameters, Json& points) {
  const Json& own = part.page.at("quantities");
  for (std::size_t i = 0; i < part.scenes.size(); ++i) {
    Json point = part.page.at("points")[i];
    Json estimates = Json::array();
    for (const Json& quantity : quantities) {
      const auto found = std::ranges::find_if(own, [&](const Json& one) {
        return one.at("path") == quantity.at("path") && one.at("unit") == quantity.at("unit");
      });
      const auto place = static_cast<std::size_t>(found - own.begin());
      estimates.push_back(found == own.end() ? Json() : point.at("estimates")[place]);
    }
    point["estimates"] = std::move(estimates);
    Json& settings = point["settings"];
    for (const Json& parameter : parameters) {
      const auto pointer = parameter.at("pointer").get<std::string>();
      if (!settings.contains(pointer)) settings[pointer] = value_in(part.scenes[i], pointer);
    }
    settings["campaign"] = part.name;
    point["label"] = fmt::format("{}: {}", part.name, point.at("label").get<std::string>());
    points.push_back(std::move(point));
  }
}

// Returns the keys that no campaign sweeps. One that differs has the value of each.
Json joined_scene(const std::vector<Part>& parts, const Json& parameters) {
  Json keys = Json::array(), joined = Json::array();
  for (const Part& part : parts) add_new(keys, part.page.at("scene"), {"pointer"});
  for (Json& key : keys) {
    const auto pointer = key.at("pointer").get<std::string>();
    const bool is_swept = std::ranges::any_of(parameters, [&](const Json& parameter) {
      const auto swept = parameter.at("pointer").get<std::string>();
      return pointer == swept || pointer.starts_with(swept + '/');
    });
    if (is_swept) continue;
    std::vector<std::string> texts;
    std::set<std::string> values;
    for (const Part& part : parts) {
      const Json value = part.scenes.empty() ? Json() : value_in(part.scenes.front(), pointer);
      const std::string text = value.is_null()     ? "–"
                               : value.is_string() ? value.get<std::string>()
                                                   : value.dump();
      values.insert(text);
      texts.push_back(fmt::format("{} ({})", text, part.name));
    }
    if (values.size() > 1) key["value"] = fmt::format("{}", fmt::join(texts, ", "));
    joined.push_back(std::move(key));
  }
  return joined;
}

}  // namespace

Json joined_page(const std::vector<NamedCampaign>& sources) {
  std::vector<Part> parts;
  parts.reserve(sources.size());
  for (const NamedCampaign& source : sources) parts.push_back(part_of(source));
  Json parameters = Json::array({campaign_parameter()});
  Json quantities = Json::array(), derived = Json::array(), meanings = Json::object(), points = Json::array(),
       warnings = Json::array(), provenance = Json::array(), documents = Json::array();
  std::vector<std::string> names, commands;
  Json swept = Json::array();
  for (const Part& part : parts) {
    add_new(swept, part.page.at("parameters"), {"pointer"});
    add_new(quantities, part.page.at("quantities"), {"path", "unit"});
    add_new(derived, part.page.at("derived"), {"name"});
  }
  for (const Part& part : parts) {
    add_points(part, quantities, swept, points);
    meanings.update(part.page.at("meanings"));
    for (Json warning : part.page.at("warnings")) {
      warning["point"] = fmt::format("{}: {}", part.name, warning.at("point").get<std::string>());
      warnings.push_back(std::move(warning));
    }
    provenance.push_back({"campaign", part.name});
    for (const Json& item : part.page.at("provenance")) provenance.push_back(item);
    documents.push_back({{"name", part.name}, {"document", part.page.at("document")}});
    names.push_back(part.name);
    commands.push_back(part.page.at("commands").get<std::string>());
  }
  Json scene = joined_scene(parts, swept);
  for (Json& parameter : swept) parameters.push_back(std::move(parameter));
  return {{"schema_version", 1},
          {"campaign", fmt::format("{}", fmt::join(names, ", "))},
          {"target", joined_target(parts)},
          {"progress", joined_progress(parts)},
          {"parameters", std::move(parameters)},
          {"quantities", std::move(quantities)},
          {"derived", std::move(derived)},
          {"points", std::move(points)},
          {"work", {{"now", Json::array()}, {"attempts", Json::array()}}},
          {"meanings", std::move(meanings)},
          {"warnings", std::move(warnings)},
          {"scene", std::move(scene)},
          {"provenance", std::move(provenance)},
          {"commands", fmt::format("{}", fmt::join(commands, "\n"))},
          {"documents", std::move(documents)}};
}

}  // namespace peclet::runner
