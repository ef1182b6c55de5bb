// Where the numbers come from, and how to make them again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "contract/sha256.h"
#include "runner/page/page_parts.h"
#include "runner/text/quoting.h"

namespace peclet::runner {
namespace {

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// Nothing is said of what is not known.
class Items {
 public:
  void add(const std::string& term, const std::string& meaning) {
    if (meaning.find_first_not_of(' ') != std::string::npos) items_.push_back({term, meaning});
  }
  void add_engine(const Json& origin) {
    std::string commit = text_of(origin, "git_commit");
    if (!commit.empty() && origin.value("git_dirty", Json()) == true) commit += ", with changes";
    add("engine", fmt::format("version {}", text_of(origin, "version")));
    add("commit", commit);
    add("binary SHA-256", text_of(origin, "binary_sha256"));
    add("instruction set", text_of(origin, "instruction_set"));
    add("compiler", text_of(origin, "compiler") + ' ' + text_of(origin, "flags"));
    add("processor", text_of(origin, "cpu"));
  }
  Json json() const { return items_; }

 private:
  Json items_ = Json::array();
};

}  // namespace

Json page_provenance(Database& database, const CampaignStatus& status, const std::string& results_sha256) {
  const CampaignRecord& campaign = status.campaign;
  Items items;
  for (const EngineRecord& engine : database.engines()) items.add_engine(engine.provenance);
  items.add("machines", fmt::format("{}", fmt::join(database.hosts(), ", ")));
  items.add("campaign begun", campaign.created_at);
  items.add("file last taken up", campaign.updated_at);
  items.add("last seed ended", database.last_end());
  items.add("campaign SHA-256", sha256(canonical_json(campaign.document)));
  if (!results_sha256.empty()) items.add("results SHA-256", results_sha256 + " (of the canonical table)");
  return items.json();
}

std::string page_commands(const CampaignStatus& status, const std::string& results_sha256) {
  const std::string file = shell_word(status.campaign.name + ".json");
  return fmt::format(
      "# with the engine above, and the campaign below as {0}\n"
      "peclet validate {0}\n"
      "peclet run {0}\n"
      "peclet export {0} --csv --canonical | sha256sum\n{1}",
      file, results_sha256.empty() ? "" : "# " + results_sha256 + '\n');
}

}  // namespace peclet::runner
