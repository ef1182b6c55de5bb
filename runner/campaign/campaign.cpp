#include "runner/campaign/campaign.h"

#include <fmt/format.h>

#include <cmath>

#include "contract/input_error.h"
#include "contract/input_file.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/sweep.h"

namespace peclet::runner {
namespace {

// With fewer, intervals of a rule with several looks hold the mean less often than 94 % (results/coverage).
constexpr int smallest_minimum = 8;

// What goes into headings and names of files.
constexpr std::size_t longest_name = 100;

// Of how many first seeds of each point files are kept.
int seeds_with_files(const Json& document, const std::string& file) {
  const Json rule = document.value("keep_files", Json("all"));
  if (rule == "all") return most_realisations;
  if (rule == "none") return 0;
  if (rule.is_number() && rule >= 0 && rule <= most_realisations && std::trunc(rule.get<double>()) == rule) {
    return rule.get<int>();
  }
  throw InputError(file, "/keep_files", shortened(rule),
                   fmt::format("must be \"all\", \"none\" or an integer >= 0 and <= {}", most_realisations));
}

}  // namespace

void check_campaign_name(const std::string& name, const std::string& file) {
  constexpr const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  if (name.empty() || name.size() > longest_name || name.find_first_not_of(allowed) != std::string::npos) {
    throw InputError(
        file, "/name", shortened(name),
        fmt::format("must be 1 to {} letters, digits, dots, underscores and hyphens", longest_name));
  }
}

Campaign read_campaign(const std::filesystem::path& path) {
  require_campaign_file(path);
  return parse_campaign(read_json_input(path), path.string());
}

Campaign parse_campaign(const Json& written, const std::string& file) {
  Campaign campaign;
  campaign.document = campaign_keys().validate(written, file);
  const Json& document = campaign.document;
  campaign.name = document["name"].get<std::string>();
  check_campaign_name(campaign.name, file);

  const Json& target = document["target"];
  campaign.target = {target["observable"].get<std::string>(), tolerance_of(target),
                     target["confidence"].get<double>()};
  campaign.minimum_realisations = document["realisations"]["minimum"].get<int>();
  campaign.maximum_realisations = document["realisations"]["maximum"].get<int>();
  if (campaign.maximum_realisations < campaign.minimum_realisations) {
    throw InputError(file, "/realisations/maximum", fmt::format("{}", campaign.maximum_realisations),
                     fmt::format("must be an integer >= minimum, {}", campaign.minimum_realisations));
  }
  if (campaign.minimum_realisations < smallest_minimum &&
      campaign.minimum_realisations != campaign.maximum_realisations) {
    throw InputError(
        file, "/realisations/minimum", fmt::format("{}", campaign.minimum_realisations),
        fmt::format("must be an integer >= {}, or equal to maximum: the spread of fewer seeds is too "
                    "uncertain to stop by",
                    smallest_minimum));
  }
  campaign.engine = document["engine"].get<std::vector<std::string>>();
  campaign.seeds_with_files = seeds_with_files(document, file);
  campaign.points = sweep_points(document["scene"], read_sweep(document["sweep"], file), campaign.name, file);
  return campaign;
}

}  // namespace peclet::runner
