#include "runner/owner/request_handler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/named_files.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/store/point_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

namespace {

template <typename Item>
std::string listed(const std::vector<Item>& items, const char* separator = ", ") {
  constexpr std::size_t most = 12;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(most, items.size()));
  std::string text = fmt::format("{}", fmt::join(items.begin(), items.begin() + shown, separator));
  if (items.size() > most) text += fmt::format("{}and {} more", separator, items.size() - most);
  return text;
}

// Returns the values in a label, as in a row of a table: "10 0.5" for "peclet=10 volume_fraction=0.5".
std::string values_in(const std::string& label) {
  std::istringstream words(label);
  std::string values;
  for (std::string word; words >> word;) {
    const std::size_t sign = word.find('=');
    if (sign != std::string::npos) values += (values.empty() ? "" : " ") + word.substr(sign + 1);
  }
  return values;
}

bool has_name(const PointRecord& point, const std::string& name) {
  return values_in(point.label) == name || (name.size() >= 4 && point.hash.starts_with(name));
}

constexpr const char* would_repeat = "ended with the engine's own verdict, and would end so again";

// Returns why a named seed cannot be retried; "" if it can.
std::string obstacle(const std::vector<RealisationRecord>& realisations, int seed) {
  const auto found = std::find_if(realisations.begin(), realisations.end(),
                                  [&](const RealisationRecord& record) { return record.seed == seed; });
  if (found == realisations.end()) return "has never been queued";
  switch (found->state) {
    case SeedState::quarantined:
      return "";
    case SeedState::failed:
      return fmt::format("{} ({})", would_repeat, found->cause);
    case SeedState::done:
      return "has completed";
    case SeedState::queued:
    case SeedState::running:
      return "was not given up: it is " + std::string(to_string(found->state));
  }
  return "";
}

void check_named(Database& database, const std::vector<PointRecord>& points, const std::vector<int>& seeds) {
  if (seeds.empty()) return;
  if (points.size() != 1) throw InputError("", "", "--seed", "needs the one point whose seeds are meant");
  const std::vector<RealisationRecord> realisations = database.realisations(points.front().id);
  for (const int seed : seeds) {
    if (const std::string why = obstacle(realisations, seed); !why.empty()) {
      throw InputError("", "", fmt::format("--seed {}", seed),
                       fmt::format("cannot be retried: at {} it {}", points.front().label, why));
    }
  }
}

void compare(std::vector<std::string>& changes, const char* what, const std::string& before,
             const std::string& after) {
  if (before != after) changes.push_back(fmt::format("{} {} -> {}", what, before, after));
}

std::string also_text(const Target& target) { return target.also.empty() ? "none" : to_string(target.also); }

// Adds changes of the numbers of realisations: "minimum 10 -> 20", or "realisations 8 to 100 -> 16" if one of
// the campaigns has a fixed number.
void compare_realisations(std::vector<std::string>& changes, const TargetRecord& before,
                          const Campaign& after) {
  const int minimum = after.minimum_realisations, maximum = after.maximum_realisations;
  if (!before.target.has_tolerance() || !after.target.has_tolerance()) {
    compare(changes, "realisations", range_text(before.minimum, before.maximum),
            range_text(minimum, maximum));
    return;
  }
  compare(changes, "minimum", std::to_string(before.minimum), std::to_string(minimum));
  compare(changes, "maximum", std::to_string(before.maximum), std::to_string(maximum));
}

std::string exact_percent(double share) { return fmt::format("{:.6g} %", 100 * share); }

void compare_points(std::vector<std::string>& changes, Database& database, const Campaign& campaign) {
  std::set<std::string> before, after;
  for (const PointRecord& point : database.points()) before.insert(point.hash);
  for (const StatePoint& point : campaign.points) after.insert(point.hash);
  const auto missing_in = [](const std::set<std::string>& those, const std::set<std::string>& these) {
    return static_cast<std::size_t>(std::count_if(
        these.begin(), these.end(), [&](const std::string& hash) { return !those.contains(hash); }));
  };
  if (const auto added = missing_in(before, after); added > 0)
    changes.push_back(counted(added, "point") + " added");
  if (const auto left = missing_in(after, before); left > 0)
    changes.push_back(counted(left, "point") + " left out");
}

// A larger file is not taken over while the campaign runs; `peclet run` reads it.
constexpr std::uint64_t largest_campaign_file = 64 << 20;

std::vector<PointRecord> named(const std::vector<PointRecord>& points,
                               const std::vector<std::string>& names) {
  std::set<std::size_t> found;
  for (const std::string& name : names) found.insert(find_point(points, name));
  std::vector<PointRecord> chosen;
  chosen.reserve(found.size());
  for (const std::size_t i : found) chosen.push_back(points[i]);
  return chosen;
}

std::string labels(const std::vector<PointRecord>& points) {
  std::vector<std::string> labels;
  labels.reserve(points.size());
  for (const PointRecord& point : points) labels.push_back(point.label);
  return listed(labels);
}

std::optional<std::int64_t> only(const std::vector<PointRecord>& points) {
  return points.size() == 1 ? std::optional(points.front().id) : std::nullopt;
}

struct RetryPlan {
  std::map<std::int64_t, std::vector<int>> seeds;  // by PointRecord::id
  std::string message;                             // the seeds, and why no more are queued
};

// Plans to retry the given-up seeds of `points`, or only `seeds` if any are named. Throws InputError if seeds
// are named for more than one point, or one of them was not given up: a seed that ended with the engine's own
// verdict would end so again.
RetryPlan plan_retry(Database& database, const std::vector<PointRecord>& points,
                     const std::vector<int>& seeds) {
  check_named(database, points, seeds);
  RetryPlan plan;
  std::size_t retried = 0, failed = 0;
  std::vector<std::string> where;
  for (const PointRecord& point : points) {
    std::vector<int> chosen;
    for (const RealisationRecord& record : database.realisations(point.id)) {
      const bool is_meant =
          seeds.empty() || std::find(seeds.begin(), seeds.end(), record.seed) != seeds.end();
      if (record.state == SeedState::failed) ++failed;
      if (record.state == SeedState::quarantined && is_meant) chosen.push_back(record.seed);
    }
    if (chosen.empty()) continue;
    retried += chosen.size();
    where.push_back(fmt::format("{} seed{} {}", point.label, chosen.size() == 1 ? "" : "s", listed(chosen)));
    plan.seeds[point.id] = std::move(chosen);
  }
  plan.message = retried == 0 ? "no seed was given up: there is nothing to retry"
                              : fmt::format("{} queued again, with a clean record: {}",
                                            counted(retried, "seed"), listed(where, "; "));
  if (failed > 0 && seeds.empty())
    plan.message += fmt::format("; {} {}", counted(failed, "seed"), would_repeat);
  return plan;
}

// Returns what a campaign file changes: "tolerance 5 % -> 3 %; 2 points added; 1 point left out", or "nothing
// differs". Requires that the database holds a campaign and has not taken this one over yet.
std::string describe_changes(Database& database, const Campaign& campaign) {
  const CampaignRecord known = database.campaign();
  const Target& before = known.target.target;
  const Target& after = campaign.target;
  std::vector<std::string> changes;
  compare(changes, "observable", before.observable, after.observable);
  compare(changes, "tolerance", to_string(before.tolerance), to_string(after.tolerance));
  compare(changes, after.has_tolerance() ? "further targets" : "also shown", also_text(before),
          also_text(after));
  compare(changes, "confidence", exact_percent(before.confidence), exact_percent(after.confidence));
  compare_realisations(changes, known.target, campaign);
  const auto kept = [](const Json& document) { return document.value("keep_files", Json("all")).dump(); };
  compare(changes, "files kept", kept(known.document), kept(campaign.document));
  compare_points(changes, database, campaign);
  if (!changes.empty()) return fmt::format("{}", fmt::join(changes, "; "));
  return known.document == campaign.document ? "nothing differs"
                                             : "parts of the file that affect no decision";
}

}  // namespace

std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].label == name) return i;
    if (has_name(points[i], name)) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  constexpr std::size_t most_labels = 12;
  std::vector<std::string> labels;
  labels.reserve(std::min(points.size(), most_labels));
  for (std::size_t i = 0; i < std::min(points.size(), most_labels); ++i)
    labels.push_back(shell_word(points[i].label));
  throw InputError(
      "", "", name,
      fmt::format(
          "must be the label of one point, its values alone, or 4 or more digits of its hash; labels: {}{}",
          fmt::join(labels, ", "), points.size() > most_labels ? ", ..." : ""));
}

bool RequestHandler::carry_out() {
  bool any = false;
  for (const fs::path& file : waiting_requests(directory_)) {
    if (left_alone_.contains(file)) continue;
    try {
      const Request request = read_request(file);
      if (!EventStore(database_.connection()).has_answered(request.name)) {
        carry_out(request);
        any = true;
      }
      fs::remove(file);
    } catch (const RequestError& error) {
      const std::optional<fs::path> aside = set_request_aside(file);
      if (!aside) left_alone_.insert(file);
      const std::string now = aside ? "set aside as " + plain_name(*aside) : "left alone";
      listener_.warn(fmt::format("requests/{}: is not a valid request: {}; it is {}", plain_name(file),
                                 plain(error.what()), now));
    } catch (const DatabaseError&) {
      state_.roll_back();
      throw;
    }
  }
  return any;
}

void RequestHandler::carry_out(const Request& request) {
  std::string why;
  try {
    Transaction booking(database_.connection());
    Done done = std::visit([&](const auto& wish) { return apply(wish); }, request.wish);
    state_.refresh();
    EventStore(database_.connection()).write(done.kind, done.point, std::nullopt, done.message, request.name);
    booking.commit();
    state_.after_commit();
    listener_.note(fmt::format("{}: {}", done.kind, done.message));
    return;
  } catch (const InputError& error) {
    why = error.what();
  } catch (const OtherEngine& error) {
    why = fmt::format("{}: stop the run first, then `peclet run` says how to accept it", error.what());
  }
  state_.roll_back();
  Transaction refusal(database_.connection());
  EventStore(database_.connection()).write("refused", std::nullopt, std::nullopt, why, request.name);
  refusal.commit();
  listener_.note("a request is refused: " + why);
}

RequestHandler::Done RequestHandler::apply(const TakeOver& wish) {
  std::string text;
  try {
    text = read_regular(fs::canonical(wish.file), largest_campaign_file);  // wish.file may be a link
  } catch (const std::system_error& error) {
    throw InputError(wish.file.string(), "", "", error.what());
  }
  const Campaign written = parse_campaign(parse_json_input(text, wish.file.string()), wish.file.string());
  // The campaign or its scene's file changed after the check; its author will send another request.
  if (hash_of(written) != wish.sha256) {
    return {"set",
            fmt::format(
                "not taken over: {} changed after it was checked; `peclet set` or `peclet run` takes it over",
                wish.file.string())};
  }
  const Campaign campaign = PointStore(database_).with_chosen_values(written);
  if (state_.has_engine() && campaign.engine != state_.campaign().engine) {
    throw InputError(wish.file.string(), "/engine", Json(campaign.engine).dump(),
                     "cannot be changed while the campaign runs: stop it, and start it again");
  }
  const std::string changes = describe_changes(database_, campaign);
  state_.take_over(campaign);
  return {"set", changes};
}

RequestHandler::Done RequestHandler::apply(const Prioritise& wish) {
  const std::vector<PointRecord> points = named(database_.points(), wish.points);
  for (const PointRecord& point : points) PointStore(database_).set_priority(point.id, wish.priority);
  return {"set", fmt::format("priority {}: {}", wish.priority, labels(points)), only(points)};
}

RequestHandler::Done RequestHandler::apply(const Cancel& wish) {
  const std::vector<PointRecord> points = named(database_.points(), wish.points);
  for (const PointRecord& point : points) PointStore(database_).set_cancelled(point.id, !wish.undo);
  return {"cancel", fmt::format("{}: {}", wish.undo ? "taken up again" : "no more seeds", labels(points)),
          only(points)};
}

RequestHandler::Done RequestHandler::apply(const Retry& wish) {
  const std::vector<PointRecord> all = database_.points();
  const std::vector<PointRecord> points = wish.points.empty() ? all : named(all, wish.points);
  const RetryPlan plan = plan_retry(database_, points, wish.seeds);
  for (const auto& [point, seeds] : plan.seeds) {
    for (const int seed : seeds) SeedStore(database_).retry(point, seed);
  }
  return {"retry", plan.message, only(points)};
}

}  // namespace peclet::runner
