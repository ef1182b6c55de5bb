// WorkerNews is what workers have said and their owner has not booked yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runner/engines/worker_pool.h"

namespace peclet::runner {

class WorkerNews {
 public:
  // Adds an event. Progress takes the place of older progress of its job if nothing else happened to its
  // worker since, so that the list stays short while nothing can be booked.
  void add(WorkerEvent event);
  const std::vector<WorkerEvent>& events() const { return events_; }
  void clear() { events_.clear(); }

  // Returns the number of processes that have ended.
  std::ptrdiff_t exits() const;
  // Returns the room [bytes] that booking needs: each result takes about the size of its file in the
  // database, and as much again in the write-ahead log.
  std::uint64_t bytes() const;

 private:
  std::vector<WorkerEvent> events_;
};

}  // namespace peclet::runner
