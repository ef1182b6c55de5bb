#include "runner/store/point_store.h"

#include <fmt/format.h>

#include "contract/errors.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/observation.h"
#include "runner/statistics/quantities.h"
#include "runner/store/number_store.h"
#include "runner/store/result_store.h"

namespace peclet::runner {

void EventStore::write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
                       const std::string& message, const std::string& request) {
  Statement(connection_,
            "INSERT INTO event (at, kind, point_id, seed, message, request) VALUES (?, ?, ?, ?, ?, ?)")
      .bind(utc_now())
      .bind(kind)
      .bind(point)
      .bind(seed)
      .bind(message)
      .bind(request.empty() ? std::nullopt : std::optional<std::string>(request))
      .run();
}

bool EventStore::has_answered(const std::string& request) {
  Statement query(connection_, "SELECT 1 FROM event WHERE request = ?");
  return query.bind(request).step();
}

namespace {

constexpr std::size_t longest_list = 350;

std::string describe(const Campaign& campaign) {
  return fmt::format("{}: {} points, {} at {:g} confidence, {} seeds", campaign.name, campaign.points.size(),
                     to_string(campaign.target), campaign.target.confidence,
                     range_text(campaign.minimum_realisations, campaign.maximum_realisations));
}

}  // namespace

void PointStore::adopt(const Campaign& campaign) {
  Transaction adoption(connection_);
  take_over(campaign);
  adoption.commit();
}

void PointStore::take_over(const Campaign& campaign) {
  const bool is_first = connection_.integer("SELECT count(*) FROM campaign") == 0;
  const bool sees_the_same =
      is_first || database_.campaign().target.target.observables() == campaign.target.observables();
  const std::int64_t target = adopt_target(campaign);
  adopt_points(campaign);
  if (!sees_the_same) observe_again(campaign);

  const std::string document = campaign.document.dump();
  const bool unchanged = connection_.text("SELECT document FROM campaign") == document;
  Statement(connection_,
            "INSERT INTO campaign (campaign_id, name, document, target_id, created_at, updated_at) "
            "VALUES (1, ?1, ?2, ?3, strftime('%Y-%m-%dT%H:%M:%SZ'), strftime('%Y-%m-%dT%H:%M:%SZ')) "
            "ON CONFLICT DO UPDATE SET name = ?1, document = ?2, target_id = ?3, updated_at = "
            "strftime('%Y-%m-%dT%H:%M:%SZ')")
      .bind(campaign.name)
      .bind(document)
      .bind(target)
      .run();
  if (!unchanged) events_.write("campaign", std::nullopt, std::nullopt, describe(campaign));
}

std::int64_t PointStore::adopt_target(const Campaign& campaign) {
  const Target& target = campaign.target;
  const char* const parts[] = {
      "INSERT OR IGNORE INTO target (observable, criterion, confidence, minimum, maximum) "
      "VALUES (?, ?, ?, ?, ?)",
      "SELECT target_id FROM target WHERE observable = ? AND criterion = ? AND confidence = ? AND "
      "minimum = ? AND maximum = ?"};
  std::int64_t id = 0;
  for (const char* const sql : parts) {
    Statement statement(connection_, sql);
    statement.bind(target.observable)
        .bind(canonical_json(criterion_json(target)))
        .bind(target.confidence)
        .bind(campaign.minimum_realisations)
        .bind(campaign.maximum_realisations);
    if (statement.step()) id = statement.integer(0);
  }
  return id;
}

void PointStore::adopt_points(const Campaign& campaign) {
  connection_.execute("UPDATE point SET place = NULL");
  Statement place(
      connection_,
      "INSERT INTO point (hash, scene, settings, label, place) VALUES (?1, ?2, ?3, ?4, ?5) "
      "ON CONFLICT (hash) WHERE kept_apart = 0 DO UPDATE SET settings = ?3, label = ?4, place = ?5");
  int number = 0;
  for (const StatePoint& point : campaign.points) {
    place.bind(point.hash)
        .bind(canonical_json(point.scene))
        .bind(canonical_json(point.settings))
        .bind(point.label)
        .bind(number++)
        .run();
  }
}

// Another observable: its numbers are taken from the results that are there.
void PointStore::observe_again(const Campaign& campaign) {
  Statement done(
      connection_,
      "SELECT point_id, seed, document, dictionary.text, place FROM result JOIN realisation USING (point_id, "
      "seed) JOIN point USING (point_id) LEFT JOIN dictionary USING (point_id) WHERE state = 'done' OR cause "
      "= ?");
  done.bind(no_value);
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
    store_numbers(connection_, done.integer(0), static_cast<int>(done.integer(1)), numbers);
    change.bind(state_of(numbers.outcome))
        .bind(cause_of(document.at("/ending/cause"_json_pointer), numbers.outcome))
        .bind(done.integer(0))
        .bind(done.integer(1))
        .run();
  }
}

void PointStore::set_priority(std::int64_t point, int priority) {
  Statement(connection_, "UPDATE point SET priority = ? WHERE point_id = ?").bind(priority).bind(point).run();
}

void PointStore::set_cancelled(std::int64_t point, bool cancelled) {
  Statement(connection_, "UPDATE point SET cancelled = ? WHERE point_id = ?")
      .bind(cancelled)
      .bind(point)
      .run();
}

void PointStore::store_prediction(std::int64_t point, const Prediction& prediction, double cpu_seconds) {
  Statement(connection_,
            "INSERT OR IGNORE INTO prediction (point_id, target_id, made_at, pilot, seeds, lower, upper, "
            "cpu_seconds) SELECT ?, target_id, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ? FROM "
            "campaign")
      .bind(point)
      .bind(prediction.pilot)
      .bind(prediction.seeds.likely)
      .bind(prediction.seeds.lower)
      .bind(prediction.seeds.upper)
      .bind(cpu_seconds)
      .run();
}

void PointStore::keep_apart(const PointRecord& point, const std::string& engine) {
  Statement(connection_, "UPDATE point SET place = NULL, kept_apart = 1 WHERE point_id = ?")
      .bind(point.id)
      .run();
  // What the engine did for the scene before, if it did, is the campaign's again. The row is the engine's
  // from now on, not only from its first result on: the one that was replaced must not take it up.
  Statement(connection_,
            "INSERT INTO point (hash, scene, settings, label, place, engine_identity, priority, cancelled) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT (hash, engine_identity) DO UPDATE SET "
            "kept_apart = 0, settings = ?3, label = ?4, place = ?5, priority = ?7, cancelled = ?8")
      .bind(point.hash)
      .bind(canonical_json(point.scene))
      .bind(canonical_json(point.settings))
      .bind(point.label)
      .bind(*point.place)
      .bind(engine)
      .bind(point.priority)
      .bind(point.cancelled)
      .run();
  events_.write("engine-accepted", point.id, std::nullopt,
                fmt::format("results of engine {} are kept apart; engine {} takes the point up",
                            point.engine_identity, engine));
}

}  // namespace peclet::runner
