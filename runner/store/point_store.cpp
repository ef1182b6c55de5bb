#include "runner/store/point_store.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/errors.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/quantities.h"
#include "runner/store/number_store.h"
#include "runner/store/result_store.h"

namespace peclet::runner {

void EventStore::write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
                       const std::string& message, const std::string& request) {
  connection_.run("INSERT INTO event (at, kind, point_id, seed, message, request) VALUES (?, ?, ?, ?, ?, ?)",
                  utc_now(), kind, point, seed, message, unless_empty(request));
}

bool EventStore::has_answered(const std::string& request) {
  return Statement(connection_, "SELECT 1 FROM event WHERE request = ?", request).step();
}

namespace {

constexpr std::size_t longest_list = 350;

std::string describe(const Campaign& campaign) {
  return fmt::format("{}: {} points, {} at {:g} confidence, {} seeds", campaign.name, campaign.points.size(),
                     to_string(campaign.target), campaign.target.confidence,
                     range_text(campaign.minimum_realisations, campaign.maximum_realisations));
}

// Returns "" unless the member is text.
std::string text_in(const Json& object, const char* member) {
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// Returns the schema one step below; null unless it is described.
const Json* below(const Json& schema, const std::string& step) {
  if (const auto items = schema.find("items"); items != schema.end()) return &*items;
  const auto properties = schema.find("properties");
  if (properties == schema.end() || !properties->is_object()) return nullptr;
  const auto found = properties->find(step);
  return found == properties->end() ? nullptr : &*found;
}

}  // namespace

void PointStore::adopt(const Campaign& campaign) {
  Transaction adoption(connection_);
  take_over(campaign);
  adoption.commit();
}

Campaign PointStore::with_chosen_values(Campaign campaign) {
  if (is_first()) return campaign;
  const Json kept = keeping_chosen_values(campaign.document, database_.campaign().document);
  return kept == campaign.document ? campaign : parse_campaign(kept, connection_.path());
}

void PointStore::take_over(const Campaign& campaign) {
  const bool sees_the_same =
      is_first() || database_.campaign().target.target.observables() == campaign.target.observables();
  const std::int64_t target = adopt_target(campaign);
  adopt_points(campaign);
  if (!sees_the_same) observe_again(campaign);

  const std::string document = campaign.document.dump();
  const bool unchanged = connection_.text("SELECT document FROM campaign") == document;
  connection_.run(
      "INSERT INTO campaign (campaign_id, name, document, target_id, created_at, updated_at) "
      "VALUES (1, ?1, ?2, ?3, strftime('%Y-%m-%dT%H:%M:%SZ'), strftime('%Y-%m-%dT%H:%M:%SZ')) "
      "ON CONFLICT DO UPDATE SET name = ?1, document = ?2, target_id = ?3, updated_at = "
      "strftime('%Y-%m-%dT%H:%M:%SZ')",
      campaign.name, document, target);
  if (!unchanged) events_.write("campaign", describe(campaign));
}

std::int64_t PointStore::adopt_target(const Campaign& campaign) {
  const Target& target = campaign.target;
  const char* const parts[] = {
      "INSERT OR IGNORE INTO target (observable, criterion, confidence, minimum, maximum) VALUES (?, ?, ?, "
      "?, ?)",
      "SELECT target_id FROM target WHERE observable = ? AND criterion = ? AND confidence = ? AND "
      "minimum = ? AND maximum = ?"};
  std::int64_t id = 0;
  for (const char* const sql : parts) {
    Statement statement(connection_, sql, target.observable, canonical_json(criterion_json(target)),
                        target.confidence, campaign.minimum_realisations, campaign.maximum_realisations);
    if (statement.step()) id = statement.integer(0);
  }
  return id;
}

void PointStore::adopt_points(const Campaign& campaign) {
  connection_.execute("UPDATE point SET place = NULL");
  Statement place(
      connection_,
      "INSERT INTO point (hash, scene, settings, label, place) VALUES (?1, ?2, ?3, ?4, ?5) "
      "ON CONFLICT (hash) WHERE set_aside = 0 DO UPDATE SET settings = ?3, label = ?4, place = ?5");
  int number = 0;
  for (const StatePoint& point : campaign.points) {
    place.run(point.hash, canonical_json(point.scene), canonical_json(point.settings), point.label, number++);
  }
}

// Takes the numbers of other observables from the stored results.
void PointStore::observe_again(const Campaign& campaign) {
  Statement done(
      connection_,
      "SELECT point_id, seed, document, dictionary.text, place FROM result JOIN realisation USING (point_id, "
      "seed) JOIN point USING (point_id) LEFT JOIN dictionary USING (point_id) WHERE state = 'done' OR cause "
      "= ?",
      no_value);
  Statement change(connection_,
                   "UPDATE realisation SET state = ?, cause = ? WHERE point_id = ? AND seed = ?");
  const std::vector<std::string> observables = campaign.target.observables();
  while (done.step()) {
    const Json document = Json::parse(result_text(done, 2, 3));
    if (const std::string lacking = lacking_in(document, observables); !done.is_null(4) && !lacking.empty()) {
      throw InputError(
          campaign.name, pointer_of(campaign.target, lacking), lacking,
          "must be a number that the results have: " + plain(names_of_targets(document), longest_list));
    }
    const ResultNumbers numbers = numbers_of(document, observables);
    store_numbers(connection_, done.integer(0), done.number(1), numbers);
    change.run(state_of(numbers.outcome),
               cause_of(document.at("/ending/cause"_json_pointer), numbers.outcome), done.integer(0),
               done.number(1));
  }
}

void PointStore::set_priority(std::int64_t point, int priority) {
  connection_.run("UPDATE point SET priority = ? WHERE point_id = ?", priority, point);
}

void PointStore::set_cancelled(std::int64_t point, bool cancelled) {
  connection_.run("UPDATE point SET cancelled = ? WHERE point_id = ?", cancelled, point);
}

void PointStore::store_prediction(std::int64_t point, const Prediction& prediction, double cpu_seconds) {
  connection_.run(
      "INSERT OR IGNORE INTO prediction (point_id, target_id, made_at, pilot, seeds, lower, upper, "
      "cpu_seconds) SELECT ?, target_id, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ? FROM "
      "campaign",
      point, prediction.pilot, prediction.seeds.likely, prediction.seeds.lower, prediction.seeds.upper,
      cpu_seconds);
}

void PointStore::set_aside(const PointRecord& point, const std::string& engine) {
  connection_.run("UPDATE point SET place = NULL, set_aside = 1 WHERE point_id = ?", point.id);
  // Results of `engine` for this scene that were set aside before belong to the campaign again. The row is
  // that engine's at once, so that the replaced engine cannot take it before the first result.
  connection_.run(
      "INSERT INTO point (hash, scene, settings, label, place, engine_identity, priority, cancelled) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT (hash, engine_identity) DO UPDATE SET "
      "set_aside = 0, settings = ?3, label = ?4, place = ?5, priority = ?7, cancelled = ?8",
      point.hash, canonical_json(point.scene), canonical_json(point.settings), point.label, *point.place,
      engine, point.priority, point.cancelled);
  events_.write("engine-accepted", point.id, std::nullopt,
                fmt::format("results of engine {} are set aside; engine {} takes the point up",
                            point.engine_identity, engine));
}

Vocabulary::Vocabulary(const Json& hello) {
  for (const char* const member : {"scene_schema", "derived"}) {
    if (hello.contains(member)) document_[member] = hello[member];
  }
}

Json Vocabulary::key(const std::string& pointer) const {
  static const Json unknown = Json::object();
  const Json* schema = document_.contains("scene_schema") ? &document_["scene_schema"] : &unknown;
  for (std::size_t at = 1; at <= pointer.size() && schema->is_object();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const Json* const next = below(*schema, pointer.substr(at, end - at));
    schema = next == nullptr ? &unknown : next;
    at = end + 1;
  }
  if (!schema->is_object()) schema = &unknown;
  return {{"pointer", pointer},
          {"words", text_in(*schema, "title")},
          {"symbol", text_in(*schema, "symbol")},
          {"unit", text_in(*schema, "unit")},
          {"meaning", text_in(*schema, "description")}};
}

void keep_vocabulary(Database& database, const Vocabulary& vocabulary) {
  Connection& connection = database.connection();
  Transaction transaction(connection);
  connection.run("DELETE FROM vocabulary");
  connection.run("INSERT INTO vocabulary (document) VALUES (?)", vocabulary.document().dump());
  transaction.commit();
}

Vocabulary kept_vocabulary(Database& database) {
  Statement kept(database.connection(), "SELECT document FROM vocabulary");
  return kept.step() ? Vocabulary(Json::parse(kept.text(0))) : Vocabulary();
}

}  // namespace peclet::runner
