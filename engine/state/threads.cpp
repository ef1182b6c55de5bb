#include "engine/state/threads.h"

#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace peclet::engine {
namespace {

// A few microseconds, longer than the usual wait of members that have a processor each.
constexpr int turns_before_yielding = 100;

void pause() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

// The value that libgomp itself uses if there are more threads than processors: a few microseconds.
constexpr const char* turns = "1000";

}  // namespace

Team::Team() = default;
Team::Team(std::span<Arrivals> arrivals, std::size_t member) : arrivals_(arrivals), member_(member) {}

bool Team::is_first() const { return member_ == 0; }

Team::Part Team::part_of(std::size_t count) const {
  const std::size_t members = arrivals_.empty() ? 1 : arrivals_.size();
  return {count * member_ / members, count * (member_ + 1) / members};
}

void Team::arrive() {
  ++arrived_;
  if (!arrivals_.empty()) arrivals_[member_].count.store(arrived_, std::memory_order_release);
}

void Team::wait() {
  for (const Arrivals& other : arrivals_) {
    for (int turn = 0; other.count.load(std::memory_order_acquire) < arrived_; ++turn) {
      // The other member may need this processor.
      turn < turns_before_yielding ? pause() : std::this_thread::yield();
    }
  }
}

void Team::meet() {
  arrive();
  wait();
}

void let_waiting_threads_sleep(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  // The variable also keeps the new process from starting itself again.
  if (setenv("GOMP_SPINCOUNT", turns, 0) == 0) execv("/proc/self/exe", arguments);
}

}  // namespace peclet::engine
