#include "runner/owner/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "contract/input_error.h"
#include "runner/folder/intruders.h"
#include "runner/folder/spool.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_list = 350;

// The folder whose spool a file lies in: the campaign's own, or one that is shared with a batch system.
CampaignDirectory home_of(const fs::path& spool_file) {
  return CampaignDirectory(spool_file.parent_path().parent_path());
}

}  // namespace

Ledger::Ledger(Database& database, const Campaign& campaign, CampaignDirectory directory,
               RunListener& listener, int retries)
    : database_(database),
      queue_(database),
      campaign_(campaign),
      directory_(std::move(directory)),
      listener_(listener),
      retries_(retries) {
  move_intruders_aside(directory_, [&](const std::string& text) { listener_.warn(text); });
  read_points();
  ingest_spool();
  if (const int recovered = queue_.recover(); recovered > 0) {
    listener_.note(fmt::format("{} seeds that an earlier run left unfinished go on", recovered));
  }
  load();
}

void Ledger::load() {
  read();
  for (const PointRecord& known : points_) {
    for (const RealisationRecord& record : database_.realisations(known.id)) {
      // A worker that outlived its owner may have saved one after its seed had ended elsewhere.
      if (!record.cause.empty()) fs::remove(directory_.checkpoint(known.hash, record.seed));
    }
  }
  Transaction booking(database_.connection());
  book_looks();
  booking.commit();
  after_commit();
}

void Ledger::read_points() {
  points_ = database_.points();
  places_.clear();
  for (const PointRecord& known : points_) places_[known.hash] = *known.place;
}

void Ledger::book_looks() {
  for (int place = 0; place < scheduler_->points(); ++place) {
    store_looks(place, database_.looks(point(place).id).size());
    if (!scheduler_->decided(place)) queue_.enqueue(point(place).id, scheduler_->wanted(place));
  }
}

void Ledger::read() {
  std::vector<std::vector<std::optional<Outcome>>> outcomes;
  costs_.assign(points_.size(), {});
  running_.assign(points_.size(), 0);
  for (const PointRecord& known : points_) {
    outcomes.push_back(database_.outcomes(known.id));
    for (const RealisationRecord& record : database_.realisations(known.id)) {
      add_cost(*known.place, record.wall_seconds, record.cpu_seconds);
    }
  }
  scheduler_.emplace(std::move(outcomes), campaign_.target, campaign_.minimum_realisations,
                     campaign_.maximum_realisations);
  for (int place = 0; place < scheduler_->points(); ++place) {
    scheduler_->set_priority(place, point(place).priority);
    scheduler_->set_cancelled(place, point(place).cancelled);
    leave_to_batch_system(place);
  }
  apply_bounds();
}

void Ledger::roll_back() {
  spent_seconds_ = committed_seconds_;
  to_discard_.clear();
  to_remove_.clear();
  to_reject_.clear();
  to_tell_.clear();
  lacking_.clear();
  if (former_) campaign_ = *std::exchange(former_, std::nullopt);
  read_points();
  read();
}

// `known` looks of the point are stored already.
void Ledger::store_looks(int place, std::size_t known) {
  const std::vector<Look>& looks = scheduler_->looks(place);
  queue_.store_looks(point(place).id, looks);
  for (std::size_t i = known; i < looks.size(); ++i) to_tell_.push_back(Looked{told_name(place), looks[i]});
  if (looks.size() > known && scheduler_->decided(place)) {
    to_tell_.push_back(Decided{told_name(place), looks.back()});
  }
}

void Ledger::book_outcome(SeedId id, const Outcome& outcome) {
  const std::size_t known = scheduler_->looks(id.point).size();
  if (!scheduler_->end(id, outcome)) return;
  const PointRecord& about = point(id.point);
  store_looks(id.point, known);
  if (!scheduler_->decided(id.point)) {
    queue_.enqueue(about.id, scheduler_->wanted(id.point));
    return;
  }
  const Look& last = scheduler_->looks(id.point).back();
  const std::string message = fmt::format("{} after {} seeds", to_string(last.verdict), last.seeds);
  queue_.event("decided", about.id, std::nullopt, message);
  to_tell_.emplace_back(Note{fmt::format("{}: {}", about.label, message)});
}

std::optional<Grant> Ledger::give_out(int worker, std::int64_t process, std::int64_t engine) {
  const std::optional<SeedId> id = next();
  if (!id) return std::nullopt;
  const PointRecord& about = point(id->point);
  Grant grant{*id, about.id, {}};
  grant.job.attempt = queue_.begin_attempt(about.id, id->seed, worker, process, engine);
  grant.job.point = about.hash;
  grant.job.seed = id->seed;
  grant.job.scene = about.scene;
  grant.job.checkpoint = directory_.checkpoint(about.hash, id->seed);
  grant.job.spool = directory_.spool_file(about.hash, id->seed, grant.job.attempt);
  grant.job.failures = directory_.failures();
  scheduler_->begin(*id);
  ++running_[static_cast<std::size_t>(id->point)];
  return grant;
}

void Ledger::end_attempt(const Grant& grant, const AttemptEnd& end) {
  leave(grant);
  spent_seconds_ += end.held_seconds;
  queue_.end_attempt(grant.job.attempt, end);
  const Sentence sentence = judge(queue_.history(grant.point_id, grant.id.seed), retries_);
  if (sentence.discard_checkpoint) to_discard_.push_back(grant.job.checkpoint);
  if (is_blamed(end.outcome)) {
    to_tell_.emplace_back(Warning{fmt::format("{}: {}{}{}; {}", name_of(grant), to_string(end.outcome),
                                              end.message.empty() ? "" : ": ", end.message,
                                              sentence.quarantine ? "it is given up" : "it is tried again")});
  }
  to_tell_.push_back(
      AttemptFailed{told_name(grant), grant.id.seed, end.outcome, end.message, sentence.quarantine});
  if (!sentence.quarantine) {
    queue_.requeue(grant.point_id, grant.id.seed);
    if (takes_part(grant.id)) scheduler_->give_back(grant.id);
    return;
  }
  queue_.quarantine(grant.point_id, grant.id.seed, sentence.cause);
  to_tell_.push_back(SeedEnded{told_name(grant), grant.id.seed, sentence.cause, std::nullopt, std::nullopt});
  if (takes_part(grant.id)) book_outcome(grant.id, Outcome{});
}

void Ledger::leave(const Grant& grant) {
  if (takes_part(grant.id)) --running_[static_cast<std::size_t>(grant.id.point)];
}

void Ledger::renew_lease(const Grant& grant, const JobProgress& progress) {
  queue_.renew_lease(grant.job.attempt, phase_name(progress.phase), progress.step, progress.steps,
                     progress.strain);
}

std::int64_t Ledger::admit_engine(const Json& engine) {
  std::string identity;
  try {
    identity = engine_identity(engine);
  } catch (const ResultError& error) {
    throw IntegrityError(fmt::format("the engine's hello does not say what it is: {}", error.what()));
  }
  if (!identity_.empty() && identity_ != identity) {
    throw IntegrityError(fmt::format("the engine changed while the campaign ran: it was {}, now it is {}",
                                     identity_, identity));
  }
  refuse_other_engine(identity);
  identity_ = identity;
  return queue_.engine(engine);
}

void Ledger::after_commit() {
  former_.reset();
  committed_seconds_ = spent_seconds_;
  for (const fs::path& file : to_discard_) fs::remove(file);
  removal_.add(to_remove_);
  for (const fs::path& file : to_reject_) reject(home_of(file), file);
  to_discard_.clear();
  to_remove_.clear();
  to_reject_.clear();
  for (const auto& told : std::exchange(to_tell_, {})) {
    if (const auto* const note = std::get_if<Note>(&told)) listener_.note(note->text);
    if (const auto* const warning = std::get_if<Warning>(&told)) listener_.warn(warning->text);
    if (const auto* const event = std::get_if<RunEvent>(&told)) listener_.happened(*event);
  }
  if (!lacking_.empty()) {
    throw InputError(campaign_.name, "/target/observable", campaign_.target.observable,
                     "must be a number that the results have: " + plain(lacking_, longest_list));
  }
}

RunReport Ledger::report(int workers) const {
  RunReport report;
  report.points = scheduler_->points();
  std::vector<PointForecast> forecasts;
  for (int place = 0; place < report.points; ++place) {
    const std::vector<Look>& looks = scheduler_->looks(place);
    const bool decided = scheduler_->decided(place);
    const bool is_left_alone = !decided && scheduler_->cancelled(place);
    report.cancelled += is_left_alone ? 1 : 0;
    report.decided += decided ? 1 : 0;
    report.converged += decided && is_converged(looks.back().verdict) ? 1 : 0;
    report.seeds_ended += scheduler_->ended(place);
    report.seeds_wanted += is_left_alone ? scheduler_->ended(place) : scheduler_->wanted(place);
    const int ended = scheduler_->all_ended(place);
    forecasts.push_back({costs_[static_cast<std::size_t>(place)].wall, scheduler_->so_far(place), ended,
                         scheduler_->begun(place) - ended, decided || is_left_alone});
  }
  report.spent_seconds = spent_seconds_;
  report.budget_seconds = bounds_.budget_seconds;
  // No forecast under a budget or a ceiling: not every point will be decided.
  if (bounds_.ceiling || bounds_.budget_seconds) return report;
  report.to_go = time_to_go(forecasts, campaign_.target, campaign_.minimum_realisations,
                            campaign_.maximum_realisations, workers);
  return report;
}

std::string Ledger::name(SeedId id) const {
  return fmt::format("{} seed {}", point(id.point).label, id.seed);
}

PointName Ledger::told_name(int place) const { return {point(place).label, point(place).hash}; }

// A point that has left the sweep is known by its hash alone.
PointName Ledger::told_name(const Grant& grant) const {
  return {grant.id.point == nowhere ? grant.job.point : point(grant.id.point).label, grant.job.point};
}

std::string Ledger::name_of(const Grant& grant) const {
  if (grant.id.point != nowhere) return name(grant.id);
  return fmt::format("{} (no longer in the sweep) seed {}", grant.job.point.substr(0, 12), grant.id.seed);
}

}  // namespace peclet::runner
