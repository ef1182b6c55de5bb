#include "engine/state/threads.h"

#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace peclet::engine {
namespace {

// Some microseconds: longer than members that have a processor each wait for one another.
constexpr int turns_before_yielding = 100;

void pause() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

// What libgomp itself gives to threads beyond the number of processors: some microseconds.
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
      // The processor may be the one that the other member needs.
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
  // Set, it also tells the program that starts now to go on.
  if (setenv("GOMP_SPINCOUNT", turns, 0) == 0) execv("/proc/self/exe", arguments);
}

}  // namespace peclet::engine
