// What bounds a run beside the campaign itself, and what it has spent.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace peclet::runner {

struct Bounds {
  std::optional<int> ceiling{};            // only so many seeds of each point
  std::optional<double> budget_seconds{};  // processor time
  std::map<std::string, double> work{};    // of a realisation, in any unit, by the point's hash
};

// Processor time that a run's attempts took.
class Spending {
 public:
  double seconds() const { return seconds_; }
  void add(double seconds) { seconds_ += seconds; }
  void back_to(double seconds) { seconds_ = seconds; }
  // What was added is durable, or is not.
  void commit() { committed_ = seconds_; }
  void roll_back() { seconds_ = committed_; }

 private:
  double seconds_ = 0, committed_ = 0;
};

}  // namespace peclet::runner
