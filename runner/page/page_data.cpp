#include "runner/page/page_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/reports/export.h"

namespace peclet::runner {
namespace {

Json target_json(const TargetRecord& target) {
  Json json = to_json(target.target);
  json["text"] = to_string(target.target);
  json["minimum"] = target.minimum;
  json["maximum"] = target.maximum;
  return json;
}

Json warnings_json(const CampaignStatus& status, const KnownPoints& known) {
  Json list = Json::array();
  for (const PointSummary& point : status.points) {
    for (const Json& warning : known.at(point.point.id).warnings) {
      list.push_back({{"point", point.point.label},
                      {"code", warning.value("code", "")},
                      {"message", warning.value("message", "")}});
    }
  }
  return list;
}

Json details_of(Database& database, const PointSummary& point, const TargetRecord& target, int seeds) {
  const int end = point.stop_tests.empty() ? std::numeric_limits<int>::max() : point.stop_tests.back().seeds;
  return point_details(database, point.point.id, end, target, seeds);
}

// Adds the details of every point, over as many seeds of each as can be read in a second or two.
void add_details(Database& database, const CampaignStatus& status, Json& points) {
  constexpr int most_results = 1000, fewest_seeds = 4;
  const int each = std::clamp(most_results / std::max(1, static_cast<int>(points.size())), fewest_seeds,
                              most_detailed_seeds);
  for (std::size_t place = 0; place < points.size(); ++place) {
    points[place]["details"] = details_of(database, status.points[place], status.campaign.target, each);
  }
}

// Returns the cost of the campaign, spent and expected, and how many workers are busy.
Json progress_json(const CampaignStatus& status) {
  const CampaignTotals totals = totals_of(status);
  return {{"points", status.points.size()},
          {"decided", totals.decided},
          {"states", totals.states},
          {"check", exit_code_of(status)},
          {"seeds",
           {{"ended", totals.ended},
            {"lost", totals.lost},
            {"extra", totals.extra},
            {"running", totals.running},
            {"handed_over", totals.handed_over}}},
          {"cpu_seconds", totals.cpu_seconds},
          {"seconds_to_go", to_json(status.to_go)},
          {"owner", status.owner ? Json(*status.owner) : Json(nullptr)},
          {"workers", status.owner ? Json(totals.workers) : Json(nullptr)}};
}

// The number of attempts in the chart of workers, for a campaign of any length.
constexpr int most_attempts = 300;

Json attempts_json(Database& database, const CampaignStatus& status) {
  std::map<std::int64_t, std::size_t> places;  // in the list of points, by PointRecord::id
  for (std::size_t i = 0; i < status.points.size(); ++i) places[status.points[i].point.id] = i;
  Json list = Json::array();
  for (const AttemptSpan& span : database.last_attempts(most_attempts)) {
    const auto place = places.find(span.point);
    if (place == places.end()) continue;
    list.push_back({{"point", place->second},
                    {"seed", span.seed},
                    {"worker", span.worker},
                    {"host", span.host},
                    {"began", span.began},
                    {"ended", span.ended},
                    {"outcome", span.outcome}});
  }
  return list;
}

Json workers_json(const CampaignStatus& status) {
  Json list = Json::array();
  if (!status.owner) return list;
  for (std::size_t i = 0; i < status.points.size(); ++i) {
    for (const LeaseRecord& lease : status.points[i].leases) {
      list.push_back({{"worker", lease.worker},
                      {"point", i},
                      {"seed", lease.seed},
                      {"phase", lease.phase},
                      {"step", lease.step},
                      {"steps", lease.steps},
                      {"strain", lease.strain}});
    }
  }
  return list;
}

// Returns pairs of a term and its meaning. Unknown meanings and an empty hash of the results are left out.
Json provenance_json(Database& database, const CampaignStatus& status, const std::string& results_sha256) {
  const CampaignRecord& campaign = status.campaign;
  Json items = Json::array();
  const auto add = [&](const std::string& term, const std::string& meaning) {
    if (meaning.find_first_not_of(' ') != std::string::npos) items.push_back({term, meaning});
  };
  for (const EngineRecord& engine : database.engines()) {
    const auto origin = [&](const char* key) {
      const Json text = engine.provenance.value(key, Json());
      return text.is_string() ? text.get<std::string>() : std::string();
    };
    const bool is_dirty = engine.provenance.value("git_dirty", Json()) == true;
    add("engine", fmt::format("version {}", origin("version")));
    add("commit", origin("git_commit") + (is_dirty && !origin("git_commit").empty() ? ", with changes" : ""));
    add("binary SHA-256", origin("binary_sha256"));
    add("instruction set", origin("instruction_set"));
    add("compiler", origin("compiler") + ' ' + origin("flags"));
    add("processor", origin("cpu"));
  }
  add("machines", fmt::format("{}", fmt::join(database.hosts(), ", ")));
  add("campaign begun", campaign.created_at);
  add("file last taken over", campaign.updated_at);
  add("last seed ended", database.last_end());
  add("campaign SHA-256", sha256(canonical_json(campaign.document)));
  if (!results_sha256.empty()) add("results SHA-256", results_sha256 + " (of the canonical CSV)");
  return items;
}

std::string commands_text(const CampaignStatus& status, const std::string& results_sha256) {
  const std::string file = shell_word(status.campaign.name + ".json");
  return fmt::format(
      "# with the engine above, and the campaign below as {0}\n"
      "peclet validate {0}\n"
      "peclet run {0}\n"
      "peclet export {0} --csv --canonical | sha256sum\n{1}",
      file, results_sha256.empty() ? "" : "# " + results_sha256 + '\n');
}

std::set<std::string> swept_pointers(const CampaignStatus& status) {
  std::set<std::string> pointers;
  for (const PointSummary& point : status.points) {
    for (const auto& [pointer, value] : point.point.settings.items()) pointers.insert(pointer);
  }
  return pointers;
}

}  // namespace

Json page_parameters(const CampaignStatus& status, const Vocabulary& words) {
  Json list = Json::array();
  for (const std::string& pointer : swept_pointers(status)) list.push_back(words.key(pointer));
  return list;
}

namespace {

// Returns the keys of the scene that all points share, with their values and the engine's words for them.
Json scene_json(const CampaignStatus& status, const Vocabulary& words) {
  Json list = Json::array();
  if (status.points.empty()) return list;
  const std::set<std::string> swept = swept_pointers(status);
  const auto is_swept = [&](const std::string& pointer) {
    return std::any_of(swept.begin(), swept.end(), [&](const std::string& set) {
      return pointer == set || pointer.starts_with(set + '/');
    });
  };
  const Json flat = status.points.front().point.scene.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (is_swept(pointer)) continue;
    list.push_back(words.key(pointer));
    list.back()["value"] = value;
  }
  return list;
}

// Returns the meaning of a mark: a verdict, or one of reservations().
std::string meaning(const std::string& mark) {
  static const std::map<std::string, std::string> meanings{
      {"converged-with-losses",
       "The interval is within the tolerance, but the mean leaves out the seeds that were lost. It is biased "
       "if "
       "the loss of a seed depends on the value that it would have given."},
      {"capped",
       "All seeds that are allowed have ended, and the interval is wider than the tolerance or does not "
       "exist."},
      {"complete-with-losses",
       "All seeds that were asked for have ended, and the mean leaves out those that were lost. It is biased "
       "if "
       "the loss of a seed depends on the value that it would have given."},
      {"failed", "Too many seeds were lost to give an interval."},
      {"open", "The point is not decided yet, and its numbers are provisional."},
      {"cancelled", "The point was cancelled and gets no more seeds; its numbers stay provisional."},
      {"jammed",
       "Half of the seeds or more have jammed. The point has no viscosity; under a given stress its shear "
       "rate "
       "is 0."},
      {"transient",
       "The beginning of the measured windows differs from their end, so that they begin before the "
       "equilibration is over. More seeds do not remove this bias."},
      {"no-transient-test",
       "The results have no blocks of the observable, so that no test can tell whether the windows begin "
       "before "
       "the equilibration is over."},
      {"skewed",
       "Some values lie far from the rest on one side. The interval holds the true mean less often than its "
       "confidence says."},
      {"near-maximum",
       "The interval is within the tolerance, but perhaps by chance: with the largest spread that the values "
       "allow, the point would need more seeds than are allowed. Intervals of such points hold the true mean "
       "less often than their confidence says."},
      {"equal-values", "All values are the same number, so that there is no spread for an interval."},
      {"repeated-seeds",
       "Some seeds ended in the same state, so that their values are not independent and have no interval."},
      {"earlier-stop-test",
       "The target was tighter before. The first stop test within the present tolerance decides, as if the "
       "target had always been this one; seeds that ended later do not count."},
      {"suspect", "A seed gave two different results. No number of this point can be trusted."},
      {"flagged jammed", "These seeds stood still under the given stress; their rate 0 is part of the mean."},
      {"flagged patience", "In these seeds the window is too short to tell whether they have jammed."},
      {"flagged timestep",
       "In these seeds the time step produced too much energy, changed the stress or was often divided."},
      {"flagged solver", "In these seeds implicit steps were solved too inaccurately."},
      {"flagged overlap",
       "In these seeds contacts overlapped by more than a thousandth of a radius in the mean."}};
  const auto known = meanings.find(mark);
  return known == meanings.end() ? "This is the engine's own mark; its warning says more." : known->second;
}

Json meanings_json(const CampaignStatus& status) {
  Json meanings = Json::object();
  for (const PointSummary& point : status.points) {
    const std::string state = state_word(point);
    const bool explains_itself =
        state == to_string(Verdict::converged) || state == to_string(Verdict::complete);
    if (!explains_itself) meanings[state] = meaning(state);
    for (const std::string& mark : reservations(point)) {
      const std::string code = mark.substr(mark.rfind(' ') + 1);
      const std::string kind = code == mark ? mark : "flagged " + code;
      meanings[kind] = meaning(kind);
    }
  }
  return meanings;
}

}  // namespace

Json PageReader::read(Database& database, std::optional<std::int64_t> owner, bool whole) {
  status_ = read_status(database, owner);
  const CampaignStatus& status = status_;
  const Vocabulary words = kept_vocabulary(database);
  PagePoints points = page_points(database, status, known_);
  if (whole) add_details(database, status, points.points);
  Json quantities = Json::array();
  for (const Drawable& one : points.drawables) quantities.push_back(to_json(one));
  const std::string results = whole ? sha256(export_csv(database, true)) : "";
  return {{"schema_version", 1},
          {"campaign", status.campaign.name},
          {"target", target_json(status.campaign.target)},
          {"progress", progress_json(status)},
          {"parameters", page_parameters(status, words)},
          {"quantities", std::move(quantities)},
          {"derived", words.derived()},
          {"points", std::move(points.points)},
          {"work", {{"now", workers_json(status)}, {"attempts", attempts_json(database, status)}}},
          {"meanings", meanings_json(status)},
          {"warnings", warnings_json(status, known_)},
          {"scene", scene_json(status, words)},
          {"provenance", provenance_json(database, status, results)},
          {"commands", commands_text(status, results)},
          {"document", status.campaign.document}};
}

const PointSummary* PageReader::find(const std::string& hash) const {
  const auto found = std::find_if(status_.points.begin(), status_.points.end(),
                                  [&](const PointSummary& point) { return point.point.hash == hash; });
  return found == status_.points.end() ? nullptr : &*found;
}

std::optional<std::string> PageReader::key(const std::string& hash) const {
  const PointSummary* const point = find(hash);
  return point == nullptr ? std::nullopt : std::optional(known_.at(point->point.id).key);
}

Json PageReader::details(Database& database, const std::string& hash) const {
  return details_of(database, *find(hash), status_.campaign.target, most_detailed_seeds);
}

Json page_data(Database& database, std::optional<std::int64_t> owner) {
  return PageReader().read(database, owner, true);
}

}  // namespace peclet::runner
