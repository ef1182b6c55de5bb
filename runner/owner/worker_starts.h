// WorkerStarts decides when launched workers are started again, and which hosts are left. Workers of this
// machine are always started.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace peclet::runner {

class WorkerStarts {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // The host of each launched worker, by its name for people; workers with the same name share a host. Empty:
  // workers run on this machine.
  explicit WorkerStarts(std::vector<std::string> hosts);

  // True if the worker may be started now: its host is not left, and its pause is over.
  bool may_start(int worker, Time now) const;
  // Records that the worker said hello.
  void greet(int worker);
  // Records that the worker gave a result.
  void get_on(int worker);
  // Records that a worker ended by itself, and how. It is started again after 1, 2, 4 ... 64 seconds, counted
  // from its last result on. A host of which no worker has ever said hello is left after five ends. Returns a
  // warning at the first end in a row and when a host is left; otherwise "".
  std::string end(int worker, const std::string& how, Time now);
  // True if every host is left.
  bool is_over() const;

 private:
  struct Host {
    std::string name;
    bool has_worked = false, is_left = false;
    int ends = 0;
  };
  struct Start {
    std::size_t host;
    int ends = 0;  // in a row
    Time earliest{};
  };
  std::vector<Host> hosts_;
  std::vector<Start> starts_;
};

}  // namespace peclet::runner
