// The dispatcher's transaction, and what it does when something is in the way: what was heard is kept until
// it can be booked.
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <variant>

#include "runner/engines/job_folders.h"
#include "runner/owner/dispatcher.h"
#include "runner/store/disk_room.h"

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
  Picture before = now_;
  try {
    Transaction booking(database_.connection());
    for (const WorkerEvent& event : news_) {
      std::visit([this](const auto& happened) { handle(happened); }, event);
    }
    give_out_seeds();
    show_leases();
    booking.commit();
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root(), bytes_of_news());
    if (!hindrance) throw;
    now_ = std::move(before);
    ledger_.roll_back();
    find_running_seeds();
    unbooked_ = true;
    begin_pause(*hindrance);
    return false;
  }
  news_.clear();
  return true;
}

bool Dispatcher::follow_up() {
  try {
    ledger_.after_commit();  // a checkpoint that is discarded goes before its seed's next attempt begins
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root());
    if (!hindrance) throw;
    uncarried_ = unbooked_ = true;
    begin_pause(*hindrance);
    return false;
  }
  uncarried_ = false;
  for (const auto& [worker, job] : std::exchange(now_.to_send, {})) pool_.assign(worker, job);
  if (!told_of_.empty() && !pause_.lasts() && !request_waits_) end_pause();
  return true;
}

// What is booked of a result is about as long as its file, and goes into log and database.
std::uint64_t Dispatcher::bytes_of_news() const {
  std::uint64_t bytes = 1 << 20;
  for (const WorkerEvent& event : news_) {
    const auto* const result = std::get_if<ResultSpooled>(&event);
    std::error_code absent;
    const std::uintmax_t size = result == nullptr ? 0 : std::filesystem::file_size(result->spool, absent);
    if (result != nullptr && !absent) bytes += 2 * size;
  }
  return bytes;
}

std::filesystem::path Dispatcher::root() const {
  return std::filesystem::path(database_.connection().path()).parent_path();
}

// Said once, however often it turns out that it is still in the way.
void Dispatcher::begin_pause(const Hindrance& hindrance) {
  pause_.begin(hindrance, clock_());
  if (!told_of_.insert(hindrance.kind()).second) return;
  listener_.happened(ShortageBegan{hindrance.text});
  listener_.warn(fmt::format(
      "{}; workers keep what they have, no further seed is given out, and the campaign goes on by "
      "itself {}",
      hindrance.text, hindrance.end));
}

void Dispatcher::look_whether_it_is_over() {
  if (!pause_.lasts()) return;
  const Time now = clock_();
  // The write-ahead log keeps its largest size, which on a small disk is most of what there is.
  if (pause_.is_looked_at(now)) database_.connection().empty_log();
  if (pause_.is_over(now)) {
    unbooked_ = false;
    return;
  }
  if (stopping_ != Stopping::no) return;
  const std::string why = pause_.in_vain(root(), now);
  if (why.empty()) return;
  listener_.warn(why + "; workers checkpoint and stop");
  stop(Stopping::draining);
}

void Dispatcher::end_pause() {
  told_of_.clear();
  listener_.note("nothing is in the way any more: the campaign goes on");
  listener_.happened(ShortageEnded{});
  for (Worker& worker : now_.workers) {
    worker.watch.renew(awake_.awake());  // nobody listened meanwhile
  }
}

// Whether a worker failed for want of room, or because folders that somebody had deleted or moved were not
// mended yet. Begins a pause where there is no room now.
bool Dispatcher::lacked_room(int number) {
  const Assignment& about = *at(number).assignment;
  if (about.lost_a_folder) return true;
  const std::optional<std::filesystem::path> folder = unwritable_folder(about.given_seed.job);
  if (folder && std::filesystem::exists(*folder)) {
    if (const int error = lack_of_room(*folder, 0); error != 0)
      begin_pause(lack_of_room_in(*folder, 0, error));
  }
  return folder.has_value();
}

// A worker that outlived an earlier owner may have left a result meanwhile; so may ours, when nothing could
// be booked any more.
void Dispatcher::settle_spool() {
  try {
    ledger_.ingest_spool();
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root());
    if (!hindrance) throw;
    ledger_.roll_back();  // nothing of it counts: what is decided is what the database says
    listener_.warn(hindrance->text + "; what workers did last is booked by the next run");
  }
}

}  // namespace peclet::runner
