#include "runner/owner/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

#include "contract/input_error.h"
#include "runner/owner/file_taking.h"
#include "runner/store/intruders.h"
#include "runner/store/result_store.h"
#include "runner/store/spool.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_list = 350;

}  // namespace

Ledger::Ledger(Database& database, const Campaign& campaign, CampaignDirectory directory,
               RunListener& listener, int retries)
    : database_(database),
      seeds_(database),
      results_(database),
      rows_(database),
      events_(database.connection()),
      campaign_(campaign),
      directory_(std::move(directory)),
      listener_(listener),
      retries_(retries) {
  move_intruders_aside(directory_, [&](const std::string& text) { listener_.warn(text); });
  board_.read_points(database_);
  ingest_spool();
  if (const int recovered = seeds_.recover(); recovered > 0) {
    listener_.note(fmt::format("{} seeds that an earlier run left unfinished go on", recovered));
  }
  remove_files_of_the_dead(database_, directory_);
  load();
}

void Ledger::load() {
  read_board();
  remove_late_checkpoints();
  Transaction booking(database_.connection());
  book_looks();
  booking.commit();
  after_commit();
}

// A worker that outlived its owner may have saved one after its seed had ended elsewhere. Files are few where
// seeds are many.
void Ledger::remove_late_checkpoints() {
  for (const fs::path& file : whole_files(directory_.checkpoints())) {
    const std::optional<SeedId> id = seed_of_checkpoint(checkpoint_of(file));
    if (id && has_ended(*id)) fs::remove(file);
  }
}

std::optional<SeedId> Ledger::seed_of_checkpoint(const fs::path& file) const {
  const std::string name = file.filename().string();
  const std::size_t hyphen = name.find('-');
  if (hyphen == std::string::npos) return std::nullopt;
  const std::string_view hash = std::string_view(name).substr(0, hyphen);
  int seed = 0;
  std::from_chars(name.data() + hyphen + 1, name.data() + name.size(), seed);
  for (const PointRecord& known : board_.points()) {
    // However the name is to be read: there is one way to write it.
    if (known.hash.starts_with(hash) && directory_.checkpoint(known.hash, seed) == file)
      return SeedId{*known.place, seed};
  }
  return std::nullopt;
}

void Ledger::book_looks() {
  for (int place = 0; place < board_.size(); ++place) {
    store_looks(place, database_.looks(point(place).id).size());
    if (!scheduler().decided(place)) seeds_.enqueue(point(place).id, scheduler().wanted(place));
  }
}

void Ledger::read_board() {
  board_.read_seeds(database_, campaign());
  for (int place = 0; place < board_.size(); ++place) leave_to_batch_system(place);
}

void Ledger::roll_back() {
  changes_ = {};
  next_campaign_.reset();
  board_.read_points(database_);
  read_board();
}

// `known` looks of the point are stored already.
void Ledger::store_looks(int place, std::size_t known) {
  const std::vector<Look>& looks = scheduler().looks(place);
  results_.store_looks(point(place).id, looks);
  for (std::size_t i = known; i < looks.size(); ++i) changes_.after.tell(Looked{point_name(place), looks[i]});
  if (looks.size() > known && scheduler().decided(place)) {
    changes_.after.tell(Decided{point_name(place), looks.back()});
  }
}

void Ledger::book_outcome(SeedId id, const Outcome& outcome) {
  const std::size_t known = scheduler().looks(id.point).size();
  if (!board_.scheduler().end(id, outcome)) return;
  const PointRecord& about = point(id.point);
  store_looks(id.point, known);
  if (!scheduler().decided(id.point)) {
    seeds_.enqueue(about.id, scheduler().wanted(id.point));
    return;
  }
  const Look& last = scheduler().looks(id.point).back();
  const std::string message = fmt::format("{} after {} seeds", to_string(last.verdict), last.seeds);
  events_.write("decided", about.id, std::nullopt, message);
  changes_.after.note(fmt::format("{}: {}", about.label, message));
}

std::optional<GivenSeed> Ledger::give_out(int worker, std::int64_t process, std::int64_t engine) {
  const std::optional<SeedId> id = next();
  if (!id) return std::nullopt;
  const PointRecord& about = point(id->point);
  GivenSeed given_seed{*id, about.id, {}};
  given_seed.job.attempt = seeds_.begin_attempt(about.id, id->seed, worker, process, engine);
  given_seed.job.point = about.hash;
  given_seed.job.seed = id->seed;
  given_seed.job.scene = about.scene;
  given_seed.job.checkpoint = directory_.checkpoint(about.hash, id->seed);
  given_seed.job.spool = directory_.spool_file(about.hash, id->seed, given_seed.job.attempt);
  given_seed.job.failures = directory_.failures();
  board_.begin(*id);
  return given_seed;
}

void Ledger::end_attempt(const GivenSeed& given_seed, const AttemptEnd& end) {
  leave(given_seed);
  changes_.spent_seconds += end.held_seconds;
  seeds_.end_attempt(given_seed.job.attempt, end);
  const SeedFate fate = judge(seeds_.history(given_seed.point_id, given_seed.id.seed), retries_);
  if (fate.discard_checkpoint) changes_.after.discard(given_seed.job.checkpoint);
  if (is_blamed(end.outcome)) {
    changes_.after.warn(fmt::format("{}: {}{}{}; {}", name_of(given_seed), to_string(end.outcome),
                                    end.message.empty() ? "" : ": ", end.message,
                                    fate.quarantine ? "it is given up" : "it is tried again"));
  }
  changes_.after.tell(
      AttemptFailed{point_name(given_seed), given_seed.id.seed, end.outcome, end.message, fate.quarantine});
  if (!fate.quarantine) {
    seeds_.requeue(given_seed.point_id, given_seed.id.seed);
    if (takes_part(given_seed.id)) board_.scheduler().give_back(given_seed.id);
    return;
  }
  seeds_.quarantine(given_seed.point_id, given_seed.id.seed, fate.cause);
  changes_.after.tell(
      SeedEnded{point_name(given_seed), given_seed.id.seed, fate.cause, std::nullopt, std::nullopt});
  if (takes_part(given_seed.id)) book_outcome(given_seed.id, Outcome{});
}

void Ledger::leave(const GivenSeed& given_seed) {
  if (takes_part(given_seed.id)) board_.leave(given_seed.id);
}

void Ledger::renew_lease(const GivenSeed& given_seed, const JobProgress& progress) {
  seeds_.renew_lease(given_seed.job.attempt, phase_name(progress.phase), progress.step, progress.steps,
                     progress.strain);
}

std::int64_t Ledger::admit_engine(const Json& engine) {
  engine_.admit(engine, board_);
  return engine_row(database_, engine);
}

void Ledger::Changes::add(Changes&& later) {
  after.add(std::move(later.after));
  spent_seconds += later.spent_seconds;
  if (later.lacking) lacking = std::move(later.lacking);
}

void Ledger::after_commit() {
  if (next_campaign_) campaign_ = *std::exchange(next_campaign_, std::nullopt);
  committed_.add(std::exchange(changes_, {}));
  committed_.after.carry_out(listener_, removal_);
  if (const std::optional<Lacking>& lacking = committed_.lacking) {
    throw InputError(campaign_.name, pointer_of(campaign_.target, lacking->observable), lacking->observable,
                     "must be a number that the results have: " + plain(lacking->names, longest_list));
  }
}

RunReport Ledger::report(int workers) {
  RunReport report;
  report.points = board_.size();
  report.has_target = campaign_.target.has_tolerance();
  for (int place = 0; place < report.points; ++place) {
    const std::vector<Look>& looks = scheduler().looks(place);
    const bool decided = scheduler().decided(place);
    const bool is_left_alone = !decided && scheduler().cancelled(place);
    report.cancelled += is_left_alone ? 1 : 0;
    report.decided += decided ? 1 : 0;
    report.converged += decided && is_reached(looks.back().verdict) ? 1 : 0;
    report.seeds_ended += scheduler().ended(place);
    report.seeds_wanted += is_left_alone ? scheduler().ended(place) : scheduler().wanted(place);
  }
  report.spent_seconds = spent_seconds();
  report.budget_seconds = board_.bounds().budget_seconds;
  // No forecast under a budget or a ceiling: not every point will be decided.
  if (board_.bounds().ceiling || report.budget_seconds) return report;
  report.to_go = time_to_go(board_.forecasts(database_.unfinished()), campaign_.target,
                            campaign_.minimum_realisations, campaign_.maximum_realisations, workers);
  return report;
}

std::string Ledger::name(SeedId id) const {
  return fmt::format("{} seed {}", point(id.point).label, id.seed);
}

PointName Ledger::point_name(int place) const { return {point(place).label, point(place).hash}; }

// A point that has left the sweep is known by its hash alone.
PointName Ledger::point_name(const GivenSeed& given_seed) const {
  return {given_seed.id.point == nowhere ? given_seed.job.point : point(given_seed.id.point).label,
          given_seed.job.point};
}

std::string Ledger::name_of(const GivenSeed& given_seed) const {
  if (given_seed.id.point != nowhere) return name(given_seed.id);
  return fmt::format("{} (no longer in the sweep) seed {}", given_seed.job.point.substr(0, 12),
                     given_seed.id.seed);
}

}  // namespace peclet::runner
