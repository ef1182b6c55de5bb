// How the ledger takes a result in: wholly or not at all.
//
// A result comes from outside, and what is done with it touches six tables, the scheduler's picture and what
// is to happen after the commit. Whatever fails on the way, nothing of it may stay: what was half stored
// would be counted.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "runner/owner/file_taking.h"
#include "runner/owner/ledger.h"
#include "runner/statistics/observation.h"
#include "runner/statistics/quantities.h"
#include "runner/store/spool.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t files_at_a_time = 64;
constexpr int most_told = 10;

std::optional<double> cost_of(const RealisationResult& result, const char* which) {
  const Json& seconds = result.document.at("cost").at(which);
  return seconds.is_number() ? std::optional(seconds.get<double>()) : std::nullopt;
}

// Whether it is the result's own fault; what fails for want of room or of a sound disk is not.
bool is_of_the_result(const std::exception& error) {
  if (const auto* const database = dynamic_cast<const DatabaseError*>(&error)) {
    return database->refuses_values();
  }
  return dynamic_cast<const ResultError*>(&error) != nullptr ||
         dynamic_cast<const Json::exception*>(&error) != nullptr ||
         dynamic_cast<const std::logic_error*>(&error) != nullptr;
}

}  // namespace

std::string Ledger::take_whole(const fs::path& spool, const Reading& read, const Booking& book) {
  Changes of_others = std::exchange(changes_, {});
  bool is_taken = false;
  std::string why;
  try {
    const RealisationResult result = read();
    Savepoint booking(database_.connection());
    book(result);
    booking.keep();
    is_taken = true;
  } catch (const std::exception& error) {
    if (!is_of_the_result(error)) throw;
    why = plain(error.what());
  }
  Changes of_result = std::exchange(changes_, std::move(of_others));
  if (is_taken) {
    changes_.add(std::move(of_result));
    return "";
  }
  if (of_result.are_on_board) read_board();
  turn_down(spool, why);
  return why;
}

void Ledger::take(const RealisationResult& result, const fs::path& spool) {
  const StoredResult stored = results_.store(result, campaign_.target);
  const auto take_in = [&] {
    take_files(database_.connection(), directory_, result, spool, stored,
               campaign_.keeps_files_of(result.seed), changes_.after);
    changes_.after.remove(spool);
  };
  switch (stored.what) {
    case Stored::stored_apart:
      take_in();
      return;
    case Stored::stored:
    case Stored::duplicate:
      take_in();
      for (const fs::path& checkpoint :
           std::set{directory_.checkpoint(result.point, result.seed),
                    home_of_spool_file(spool).checkpoint(result.point, result.seed)}) {
        changes_.after.remove(checkpoint);
        changes_.after.remove(growing_beside(checkpoint));
      }
      break;
    case Stored::conflict:
      turn_down(spool, "another run of the same seed gave another result");
      return;
    case Stored::mixed_engine:
      turn_down(spool, "its point has results of another engine");
      return;
    case Stored::unknown_point:
      turn_down(spool, "it belongs to no point of this campaign");
      return;
  }
  const std::optional<int> place = board_.place_of(result.point);
  if (stored.what == Stored::duplicate || !place) return;
  if (result.completed()) note_lacking(result);
  const bool is_lost = stored.outcome.is_lost();
  const std::optional<double> value = is_lost ? std::nullopt : std::optional(stored.outcome.value);
  const std::optional<double> cpu_seconds = cost_of(result, "cpu_seconds");
  changes_.after.tell(SeedEnded{point_name(*place), result.seed, stored.cause, value, cpu_seconds});
  if (!board_.has_seeds()) return;  // load() finds it
  changes_.are_on_board = true;
  board_.add_cost(*place, cost_of(result, "wall_seconds"), cpu_seconds);
  if (is_lost) {
    changes_.after.note(fmt::format("{}: ended with {}{}{}", name({*place, result.seed}), stored.cause,
                                    stored.reason.empty() ? "" : ": ", stored.reason));
  }
  book_outcome({*place, result.seed}, stored.outcome);
}

void Ledger::note_lacking(const RealisationResult& result) {
  const std::string name = lacking_in(result.document, campaign_.target.observables());
  if (name.empty()) return;
  const std::string names = names_of_targets(result.document);
  changes_.lacking = {name, names.empty() ? "none" : names};
}

void Ledger::turn_down(const fs::path& spool, const std::string& why) {
  const std::string message = fmt::format("{} is not taken: {}", plain_name(spool), why);
  events_.write("rejected", std::nullopt, std::nullopt, message);
  // Of a crowd nobody reads every name.
  if (++turned_down_ <= most_told) {
    changes_.after.warn(
        fmt::format("{}; it is kept in {}", message, home_of_spool_file(spool).rejected().string()));
  }
  if (is_there(spool)) changes_.after.reject(spool);
}

void Ledger::ingest_spool_of(const CampaignDirectory& directory) {
  turned_down_ = 0;
  // Some at a time, because each commit waits for the disk: a crash in between finds the rest where it was.
  const std::vector<fs::path> files = spool_files(directory);
  for (std::size_t next = 0; next < files.size();) {
    const std::size_t end = std::min(files.size(), next + files_at_a_time);
    Transaction booking(database_.connection());
    for (; next < end; ++next) ingest(files[next]);
    booking.commit();
    after_commit();
  }
  if (const int told = std::exchange(turned_down_, 0); told > most_told) {
    listener_.warn(fmt::format("{} more files in {} are not taken: the table `event` says why",
                               told - most_told, directory.spool().string()));
  }
}

void Ledger::ingest(const fs::path& file) {
  const auto read = [&file] {
    RealisationResult result = read_spool_file(file, "");
    // An engine that answers with another seed's result may die before it is found out.
    if (belongs_to_another(file, result)) throw ResultError("it is named for another point or seed");
    return result;
  };
  take_whole(file, read, [&](const RealisationResult& result) { take(result, file); });
}

bool Ledger::take_result(const GivenSeed& given_seed, const std::string& sha256, std::int64_t step,
                         double held_seconds, std::string& why) {
  turned_down_ = 0;
  const auto read = [&] {
    RealisationResult result = read_spool_file(given_seed.job.spool, sha256);
    if (result.point != given_seed.job.point || result.seed != given_seed.job.seed) {
      throw ResultError("it is of another point or seed than the job");
    }
    if (result.engine != engine_.identity()) {
      throw ResultError("it names another engine than the worker's hello");
    }
    return result;
  };
  why = take_whole(given_seed.job.spool, read, [&](const RealisationResult& result) {
    take(result, given_seed.job.spool);
    seeds_.end_attempt(given_seed.job.attempt, {AttemptOutcome::result, step});
    changes_.spent_seconds += std::min(held_seconds, cost_of(result, "cpu_seconds").value_or(held_seconds));
    leave(given_seed);
  });
  return why.empty();
}

}  // namespace peclet::runner
