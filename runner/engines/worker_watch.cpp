#include "runner/engines/worker_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace peclet::runner {
namespace {

constexpr Awake longest_turn{1};
constexpr Awake hello_patience{60};

}  // namespace

void AwakeClock::end_turn(Time now) {
  awake_ += std::min<Awake>({now - heard_, longest_turn, lease_ / 2});
  heard_ = now;
}

void WorkerWatch::start(Awake now) {
  *this = {};
  stage_ = Stage::starting;
  since_ = now;
}

void WorkerWatch::rest(Awake now) {
  stage_ = Stage::idle;
  since_ = now;
}

void WorkerWatch::begin_job(Awake now) {
  stage_ = Stage::busy;
  since_ = renewed_ = now;
  progress_ = {};
}

void WorkerWatch::hear(const Progressed& progress, Awake now) {
  if (std::tie(progress.phase, progress.step) > std::tie(progress_.phase, progress_.step)) renewed_ = now;
  progress_ = {progress.phase, progress.step, progress.steps, progress.strain};
}

void WorkerWatch::condemn(AttemptReason reason) {
  if (!condemned_) condemned_ = std::move(reason);
}

bool WorkerWatch::is_overdue(Awake now, Awake lease) const {
  if (condemned_) return false;
  return (stage_ == Stage::starting && now - since_ > hello_patience) ||
         (is_busy() && now - renewed_ > lease);
}

AttemptReason WorkerWatch::overdue(Awake lease, bool is_stopped) const {
  if (stage_ == Stage::starting) return {AttemptOutcome::hung, "it did not say hello"};
  const char* const why = is_recalled_ ? ": it was told to leave"
                          : is_stopped ? ": its process has been stopped"
                                       : "";
  return {is_recalled_ || is_stopped ? AttemptOutcome::killed : AttemptOutcome::hung,
          fmt::format("no new step after {} for {:g} s{}", progress_.step, lease.count(), why)};
}

AttemptReason WorkerWatch::ended(const ExitStatus& ending, bool all_recalled) const {
  if (condemned_) return *condemned_;
  const bool left = (all_recalled || is_recalled_) && ending.status == 0;
  return {left ? AttemptOutcome::drained : outcome_of(ending), to_string(ending)};
}

}  // namespace peclet::runner
