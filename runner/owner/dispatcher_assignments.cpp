// What workers have in hand: the seed that each one runs, and perhaps one that waits for its end.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "runner/owner/dispatcher.h"
#include "runner/store/spool.h"

namespace peclet::runner {
namespace {

// Mean seconds of jobs that it is worth having another one wait for. A commit takes some hundredth of a
// second, for which a worker with longer jobs need not have one; and a seed behind a long one would make the
// decision of its point wait, while workers become idle that could run it.
constexpr double longest_job_to_queue_behind = 1;

}  // namespace

// Idle workers first: a seed waits for none that could begin it.
void Dispatcher::give_out_seeds() {
  if (stopping_ != Stopping::no || pause_.lasts() || ledger_.scheduler().finished()) return;
  for (int number = 0; number < pool_.size(); ++number) {
    Worker& worker = at(number);
    if (!worker.watch.is_idle() || worker.watch.is_recalled()) continue;
    worker.assignment = next_assignment(number);
    if (!worker.assignment) return;
    worker.watch.begin_job(awake_.awake());
  }
  for (int number = 0; number < pool_.size(); ++number) {
    Worker& worker = at(number);
    if (!takes_a_second_job(worker)) continue;
    worker.waiting = next_assignment(number);
    if (!worker.waiting) return;
  }
}

// Books the next seed as this worker's, to be sent after the commit; nothing when there is none.
std::optional<Dispatcher::Assignment> Dispatcher::next_assignment(int number) {
  std::optional<GivenSeed> given_seed = ledger_.give_out(number, pool_.process(number), at(number).engine);
  if (!given_seed) return std::nullopt;
  given_seed->job.threads = settings_.threads;
  given_seed->job.checkpoint_seconds = settings_.checkpoint_seconds;
  // Several reports fit into a lease.
  given_seed->job.progress_seconds = std::min(1.0, settings_.lease.count() / 5);
  now_.to_send.emplace_back(number, given_seed->job);
  given_seed->job.scene = nullptr;  // sent once; the rest is copied at every turn
  Assignment about{std::move(*given_seed)};
  about.given = about.begun = clock_();
  return about;
}

bool Dispatcher::takes_a_second_job(const Worker& worker) const {
  if (!worker.watch.is_busy() || !worker.takes_ahead || worker.waiting) return false;
  if (worker.watch.condemned() || worker.watch.is_recalled()) return false;
  const std::optional<double> seconds = ledger_.wall_seconds(worker.assignment->given_seed);
  return seconds && *seconds < longest_job_to_queue_behind;
}

bool Dispatcher::has_job(int worker, std::int64_t job) {
  const Worker& about = at(worker);
  if (about.watch.condemned()) return false;
  if (about.assignment && about.assignment->given_seed.job.attempt == job) return true;
  if (about.finished_job == job) return false;  // said once too often, which does no harm
  condemn(worker, {AttemptOutcome::garbled, fmt::format("spoke of job {}, which it does not have", job)});
  return false;
}

void Dispatcher::mark_lost_folders() {
  for (Worker& worker : now_.workers) {
    for (std::optional<Assignment>* const about : {&worker.assignment, &worker.waiting}) {
      if (*about) (*about)->lost_a_folder = true;
    }
  }
}

void Dispatcher::go_on(int number) {
  Worker& worker = at(number);
  worker.finished_job = worker.assignment->given_seed.job.attempt;
  worker.assignment = std::exchange(worker.waiting, std::nullopt);
  if (!worker.assignment) return worker.watch.rest(awake_.awake());
  worker.assignment->begun = clock_();
  worker.watch.begin_job(awake_.awake());
}

double Dispatcher::processor_seconds_since(Time time) const {
  return settings_.threads * std::chrono::duration<double>(clock_() - time).count();
}

void Dispatcher::end_assignment(int number, const AttemptEnd& end) {
  const Assignment& about = *at(number).assignment;
  AttemptEnd complete = end;
  complete.step = at(number).watch.progress().step;
  complete.held_seconds = processor_seconds_since(about.begun);
  ledger_.end_attempt(about.given_seed, complete);
  go_on(number);
}

// A result may be durable although nobody could announce it any more; one that was turned down stays so.
bool Dispatcher::left_result(int number, const Assignment& about, std::int64_t step) {
  const std::optional<AttemptReason>& condemned = at(number).watch.condemned();
  std::string why;
  if ((condemned && condemned->outcome == AttemptOutcome::garbled) || !is_there(about.given_seed.job.spool) ||
      !ledger_.take_result(about.given_seed, "", step, processor_seconds_since(about.given), why)) {
    return false;
  }
  ++now_.results;
  return true;
}

void Dispatcher::give_back(const Assignment& waiting) {
  ledger_.end_attempt(waiting.given_seed, {AttemptOutcome::drained, 0, {}, "waited behind another job"});
}

}  // namespace peclet::runner
