// The last section of a report: where its numbers come from, and how to make them again.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "contract/sha256.h"
#include "runner/reports/report_sections.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

constexpr const char* about_repetition =
    "The same engine gives the same bytes with any number of workers: the last line tells whether the "
    "numbers are the same. Another build gives other bytes, and means that agree within their errors.";

// Nothing is said of what is not known.
std::string item(const std::string& term, const std::string& meaning) {
  return meaning.empty() ? "" : list_item(term, meaning);
}

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string engine_items(const EngineRecord& engine) {
  const Json& origin = engine.provenance;
  std::string commit = text_of(origin, "git_commit");
  if (!commit.empty() && origin.value("git_dirty", Json()) == true) commit += ", with changes";
  return item("engine", fmt::format("version {}", text_of(origin, "version"))) + item("commit", commit) +
         item("binary SHA-256", text_of(origin, "binary_sha256")) +
         item("instruction set", text_of(origin, "instruction_set")) +
         item("compiler", text_of(origin, "compiler") + ' ' + text_of(origin, "flags")) +
         item("processor", text_of(origin, "cpu"));
}

struct Attempts {
  std::set<std::string> hosts;
  std::string last;  // time at which one ended
};

Attempts attempts(Database& database, const std::vector<PointSummary>& points) {
  Attempts all;
  for (const PointSummary& point : points) {
    for (const AttemptRecord& attempt : database.attempts(point.point.id)) {
      if (!attempt.host.empty()) all.hosts.insert(attempt.host);
      all.last = std::max(all.last, attempt.ended_at);
    }
  }
  return all;
}

std::string commands(const CampaignStatus& status, const std::string& canonical_sha256) {
  const std::string& name = status.campaign.name;
  return fmt::format(
      "# with the engine above, and the campaign below as {0}.json\n"
      "peclet validate {0}.json\n"
      "peclet run {0}.json\n"
      "peclet export {0}.json --canonical | sha256sum\n"
      "# {1}\n",
      name, canonical_sha256);
}

}  // namespace

std::string provenance_section(Database& database, const CampaignStatus& status,
                               const std::string& canonical_sha256) {
  const CampaignRecord& campaign = status.campaign;
  const Attempts work = attempts(database, status.points);
  std::string hosts;
  for (const std::string& host : work.hosts) hosts += (hosts.empty() ? "" : ", ") + host;
  std::string list;
  for (const EngineRecord& engine : database.engines()) list += engine_items(engine);
  list += item("machines", hosts);
  list += item("campaign begun", campaign.created_at);
  list += item("file last taken up", campaign.updated_at);
  list += item("last seed ended", work.last);
  list += item("campaign SHA-256", sha256(canonical_json(campaign.document)));
  list += item("results SHA-256", canonical_sha256 + " (of the canonical export)");
  return "<section>\n<h2>Where this comes from</h2>\n<dl>\n" + list + "</dl>\n</section>\n" +
         "<section>\n<h2>To make it again</h2>\n<pre>" + escaped(commands(status, canonical_sha256)) +
         "</pre>\n<p class=\"faint\">" + about_repetition + "</p>\n</section>\n" +
         "<section class=\"long\">\n<h2>The campaign</h2>\n"
         "<p class=\"faint\">As it was last run, with defaults filled in.</p>\n<pre>" +
         escaped(campaign.document.dump(2)) + "</pre>\n</section>\n";
}

}  // namespace peclet::runner
