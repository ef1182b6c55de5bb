#include "runner/reports/export.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "runner/statistics/look_json.h"
#include "runner/statistics/quantity_estimates.h"
#include "runner/store/database_summary.h"
#include "runner/store/file_store.h"

namespace peclet::runner {
namespace {

// What of a result depends on scene, seed and engine alone. Blocks stay in the database.
Json content(const Json& result) {
  Json kept = Json::object();
  for (const char* const key :
       {"seed", "ending", "mean", "method", "timestep", "steps", "strain", "time", "statistical_inefficiency",
        "largest_overlap", "warnings", "gate", "final_state_sha256"}) {
    if (result.contains(key)) kept[key] = result[key];
  }
  kept["ending"].erase("state");  // where this machine keeps it
  return kept;
}

// A seed that was given up has no result of its own.
Json content_without_result(const RealisationRecord& record) {
  return {{"seed", record.seed}, {"ending", {{"cause", record.cause}}}, {"mean", nullptr}};
}

Json attempt_json(const AttemptRecord& attempt) {
  const auto optional = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  return {{"worker", attempt.worker},
          {"process", attempt.process},
          {"host", attempt.host},
          {"started_at", attempt.started_at},
          {"ended_at", attempt.ended_at.empty() ? Json(nullptr) : Json(attempt.ended_at)},
          {"outcome", attempt.outcome},
          {"blamed", attempt.blamed},
          {"pardoned", attempt.pardoned},
          {"step", attempt.step},
          {"exit_status", optional(attempt.exit_status)},
          {"signal", optional(attempt.signal)},
          {"message", attempt.message}};
}

// Where it is below the campaign's folder; null where it was thrown away.
Json file_json(const FileRecord& record) {
  const Json place = record.kept ? Json(record.place(CampaignDirectory("")).string()) : Json(nullptr);
  return {{"name", record.file.name},
          {"bytes", record.file.bytes},
          {"sha256", record.file.sha256},
          {"path", place}};
}

// The seeds of one point as they go into the document.
class PointExport {
 public:
  PointExport(Database& database, const PointRecord& point, const TargetRecord& target, bool canonical)
      : database_(database),
        point_(point),
        canonical_(canonical),
        look_(checked_look(database, point, target)),
        level_(target.level()) {
    if (!canonical_) {
      for (const AttemptRecord& attempt : database.attempts(point.id)) {
        attempts_[attempt.seed].push_back(attempt_json(attempt));
      }
      for (const FileRecord& record : files_of_point(database.connection(), point.id)) {
        files_[record.seed].push_back(file_json(record));
      }
    }
    read_results();
    read_seeds();
  }

  Json json() const {
    Json json = {{"label", point_.label},
                 {"hash", point_.hash},
                 {"scene", point_.scene},
                 {"settings", point_.settings},
                 {"engine", point_.engine_identity.empty() ? Json(nullptr) : Json(point_.engine_identity)},
                 {"look", look_ ? look_json(*look_) : Json(nullptr)},
                 {"verdict",
                  look_ && look_->verdict != Verdict::more ? Json(to_string(look_->verdict)) : Json(nullptr)},
                 {"derived", derived_},
                 {"warnings", warnings_},
                 {"quantities", estimates_.json(level_)},
                 {"realisations", realisations_}};
    if (!canonical_) {
      json["suspect"] = point_.suspect;
      json["cancelled"] = point_.cancelled;
      json["kept_apart"] = Json::array();
      for (const KeptApart& kept : database_.kept_apart(point_.hash))
        json["kept_apart"].push_back({{"engine", kept.engine}, {"results", kept.results}});
      json["surplus"] = surplus_;
    }
    return json;
  }

 private:
  int seeds() const { return look_ ? look_->seeds : 0; }

  void read_results() {
    const int end = canonical_ ? seeds() : std::numeric_limits<int>::max();
    database_.for_each_result(point_.id, end, [this](int seed, const Json& result) {
      if (seed < seeds()) estimates_.add(result);
      if (derived_.is_null()) {
        derived_ = result.value("derived", Json());
        warnings_ = result.value("warnings", Json());
      }
      Json kept = content(result);
      if (!canonical_) {
        kept["cost"] = result["cost"];
        kept["ending"]["state"] = result["ending"].value("state", Json());
      }
      results_[seed] = std::move(kept);
    });
  }

  void read_seeds() {
    for (const RealisationRecord& record : database_.realisations(point_.id)) {
      const bool has_ended = record.state != SeedState::queued && record.state != SeedState::running;
      if (!has_ended || (canonical_ && record.seed >= seeds())) continue;
      const auto result = results_.find(record.seed);
      Json json = result != results_.end() ? result->second : content_without_result(record);
      if (!record.content_sha256.empty()) json["content_sha256"] = record.content_sha256;
      if (!canonical_) {
        json["files"] = files_.contains(record.seed) ? files_.at(record.seed) : Json::array();
        json["attempts"] = attempts_[record.seed];
        json["engine"] = record.engine ? Json(*record.engine) : Json(nullptr);
      }
      (record.seed < seeds() ? realisations_ : surplus_).push_back(std::move(json));
    }
  }

  Database& database_;
  const PointRecord& point_;
  bool canonical_;
  std::optional<Look> look_;
  std::map<int, Json> attempts_, files_, results_;
  Json derived_, warnings_;
  Json realisations_ = Json::array(), surplus_ = Json::array();
  double level_;
  QuantityEstimates estimates_;
};

Json heading(Database& database, const CampaignRecord& campaign, bool canonical) {
  const TargetRecord& target = campaign.target;
  Json json = {{"schema_version", 1},
               {"campaign", campaign.name},
               {"target", to_json(target.target)},
               {"realisations", {{"minimum", target.minimum}, {"maximum", target.maximum}}},
               {"points", nullptr}};
  if (canonical) return json;
  json["document"] = campaign.document;
  json["engines"] = Json::object();
  for (const EngineRecord& engine : database.engines()) {
    json["engines"][std::to_string(engine.id)] = engine.provenance;
  }
  return json;
}

}  // namespace

std::string export_json(Database& database, bool canonical) {
  // Point by point, so that the memory is that of one point and the text.
  const CampaignRecord campaign = database.campaign();
  const Json outermost = heading(database, campaign, canonical);
  std::string text;
  for (const auto& [key, value] : outermost.items()) {
    text += (text.empty() ? "{" : ",") + Json(key).dump() + ':';
    if (key != "points") {
      text += canonical_json(value);
      continue;
    }
    const char* separator = "[\n";
    std::vector<PointSummary> summaries;
    if (!canonical) summaries = summarise_points(database, campaign.target);
    for (const PointRecord& record : database.points()) {
      Json point = PointExport(database, record, campaign.target, canonical).json();
      if (!canonical) point["endings"] = to_json(summaries[static_cast<std::size_t>(*record.place)].endings);
      text += separator + canonical_json(point);
      separator = ",\n";
    }
    text += "\n]";
  }
  return text + "}\n";
}

}  // namespace peclet::runner
