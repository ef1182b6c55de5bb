// Threads that do one piece of work together, each its part, and wait for each other on the way.
//
// Nothing is defined here, because this is shared with files that are compiled for one processor only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace peclet::engine {

// A team as one of its members sees it.
class Team {
 public:
  // How often each member has arrived, far enough apart for none to disturb another's.
  struct alignas(64) Arrivals {
    std::atomic<std::uint64_t> count = 0;
  };

  Team();  // of one
  Team(std::span<Arrivals> arrivals, std::size_t member);

  bool is_first() const;

  struct Part {
    std::size_t begin, end;
  };
  // This member's part of [0, count): consecutive, about as large as the others'.
  Part part_of(std::size_t count) const;

  // Whoever waits for this arrival sees what this member has done before it.
  void arrive();
  // Until every member has arrived as often as this one. Between arrival and wait there may be work: then
  // members seldom wait, though their parts take different times.
  void wait();
  void meet();  // arrives and waits

 private:
  std::span<Arrivals> arrivals_;
  std::size_t member_ = 0;
  std::uint64_t arrived_ = 0;
};

}  // namespace peclet::engine
