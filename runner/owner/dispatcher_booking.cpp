// The dispatcher's transaction, and what it does when the disk is full: what was heard is kept until it can
// be booked.
#include <algorithm>
#include <system_error>
#include <utility>
#include <variant>

#include "runner/owner/dispatcher.h"

namespace peclet::runner {
namespace {

// The longest that a turn waits: leases and the time limit are judged at least this often.
constexpr std::chrono::milliseconds longest_wait{500};

int worker_of(const WorkerEvent& event) {
  return std::visit(
      [](const auto& happened) {
        if constexpr (requires { happened.worker; }) {
          return happened.worker;
        } else {
          return -1;
        }
      },
      event);
}

// The news of a worker's progress that `later` makes old, if that is what it said last; otherwise null.
Progressed* superseded(std::vector<WorkerEvent>& news, const Progressed& later) {
  const auto last = std::find_if(news.rbegin(), news.rend(),
                                 [&](const WorkerEvent& event) { return worker_of(event) == later.worker; });
  auto* const progress = last == news.rend() ? nullptr : std::get_if<Progressed>(&*last);
  return progress != nullptr && progress->job == later.job && progress->phase == later.phase ? progress
                                                                                             : nullptr;
}

}  // namespace

// Signals are obeyed at once, whatever may become of the booking.
void Dispatcher::listen() {
  for (WorkerEvent& event : pool_.wait(longest_wait)) {
    if (std::holds_alternative<StopSignal>(event)) {
      obey_stop_signal();
      continue;
    }
    if (unbooked_ && std::holds_alternative<ShortOfRoom>(event)) continue;  // it will say so again
    // Tells a drained worker to leave now: booking may take long.
    if (const auto* const drained = std::get_if<Drained>(&event); unbooked_ && drained != nullptr) {
      pool_.drain(drained->worker);
    }
    // While nothing can be booked, this keeps what was heard short.
    const auto* const progress = std::get_if<Progressed>(&event);
    if (Progressed* const before = progress != nullptr ? superseded(news_, *progress) : nullptr) {
      *before = *progress;
    } else {
      news_.push_back(std::move(event));
    }
  }
  awake_.end_turn(clock_());
}

bool Dispatcher::book() {
  const Picture before = now_;
  try {
    Transaction booking(database_.connection());
    for (const WorkerEvent& event : news_) {
      std::visit([this](const auto& happened) { handle(happened); }, event);
    }
    give_out_seeds();
    show_leases();
    booking.commit();
  } catch (const std::exception& error) {
    if (!means_no_room(error)) throw;
    take_back(before);
    return false;
  }
  news_.clear();
  if (told_of_shortage_ && !shortage_.lasts() && !request_waits_) end_shortage();
  return true;
}

void Dispatcher::take_back(const Picture& before) {
  now_ = before;
  to_send_.clear();
  ledger_.roll_back();
  mark_running_seeds();
  unbooked_ = true;
  // What is booked of a result is about as long as its file, and goes into log and database.
  std::uint64_t bytes = 1 << 20;
  for (const WorkerEvent& event : news_) {
    const auto* const result = std::get_if<ResultSpooled>(&event);
    std::error_code absent;
    const std::uintmax_t size = result == nullptr ? 0 : std::filesystem::file_size(result->spool, absent);
    if (result != nullptr && !absent) bytes += 2 * size;
  }
  begin_shortage(std::filesystem::path(database_.connection().path()).parent_path(), bytes);
}

// Said once, however often it turns out that there still is too little.
void Dispatcher::begin_shortage(const std::filesystem::path& folder, std::uint64_t bytes) {
  shortage_.begin(folder, bytes, clock_());
  if (std::exchange(told_of_shortage_, true)) return;
  listener_.happened(ShortageBegan{shortage_.text()});
  listener_.warn(
      shortage_.text() +
      "; workers keep what they have, no further seed is given out, and the campaign goes on by itself "
      "when there is room");
}

void Dispatcher::look_for_room() {
  if (!shortage_.lasts()) return;
  const Time now = clock_();
  // The write-ahead log keeps its largest size, which on a small disk is most of what there is.
  if (shortage_.is_looked_at(now)) database_.connection().empty_log();
  if (shortage_.is_over(now)) {
    unbooked_ = false;
    return;
  }
  if (stopping_ != Stopping::no) return;
  const std::filesystem::path root = std::filesystem::path(database_.connection().path()).parent_path();
  const std::string why = shortage_.in_vain(root, now);
  if (why.empty()) return;
  listener_.warn(why + "; workers checkpoint and stop");
  stop(Stopping::draining);
}

void Dispatcher::end_shortage() {
  told_of_shortage_ = false;
  listener_.note("there is room again: the campaign goes on");
  listener_.happened(ShortageEnded{});
  for (Worker& worker : now_.workers) {
    worker.watch.renew(awake_.awake());  // nobody listened meanwhile
  }
}

// An engine that does not know how to wait for room may crash or give up instead. So may any whose folders
// somebody has deleted or moved.
bool Dispatcher::lacked_room(int number) {
  const Job& job = at(number).assignment->given_seed.job;
  for (const std::filesystem::path& folder :
       {job.spool.parent_path(), job.checkpoint.parent_path(), job.failures}) {
    if (!std::filesystem::exists(folder)) return true;
    if (has_room(folder, 0)) continue;
    begin_shortage(folder, 0);
    return true;
  }
  return false;
}

// A worker that outlived an earlier owner may have left a result meanwhile; so may ours, when nothing could
// be booked any more.
void Dispatcher::settle_spool() {
  try {
    ledger_.ingest_spool();
  } catch (const std::exception& error) {
    if (!means_no_room(error)) throw;
    ledger_.roll_back();  // nothing of it counts: what is decided is what the database says
    listener_.warn("there is no room to book what workers did last: the next run does it");
  }
}

}  // namespace peclet::runner
