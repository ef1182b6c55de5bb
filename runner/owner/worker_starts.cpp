#include "runner/owner/worker_starts.h"

#include <fmt/format.h>

#include <algorithm>

namespace peclet::runner {
namespace {

constexpr int most_ends_without_hello = 5;
constexpr int most_doublings = 6;

}  // namespace

WorkerStarts::WorkerStarts(std::vector<std::string> hosts) {
  for (std::string& name : hosts) {
    const auto known = std::ranges::find(hosts_, name, &Host::name);
    starts_.push_back({static_cast<std::size_t>(known - hosts_.begin())});
    if (known == hosts_.end()) hosts_.push_back({std::move(name)});
  }
}

bool WorkerStarts::may_start(int worker, Time now) const {
  if (starts_.empty()) return true;
  const Start& start = starts_.at(static_cast<std::size_t>(worker));
  return !hosts_[start.host].is_left && now >= start.earliest;
}

void WorkerStarts::greet(int worker) {
  if (!starts_.empty()) hosts_[starts_.at(static_cast<std::size_t>(worker)).host].has_worked = true;
}

void WorkerStarts::get_on(int worker) {
  if (!starts_.empty()) starts_.at(static_cast<std::size_t>(worker)).ends = 0;
}

std::string WorkerStarts::end(int worker, const std::string& how, Time now) {
  Start& start = starts_.at(static_cast<std::size_t>(worker));
  Host& host = hosts_[start.host];
  start.earliest = now + std::chrono::seconds(1 << std::min(start.ends, most_doublings));
  const bool is_first = start.ends++ == 0;
  if (host.is_left) return "";
  if (!host.has_worked && ++host.ends >= most_ends_without_hello) {
    host.is_left = true;
    return fmt::format(
        "{}: no worker has said hello in {} tries, and no further one is made: {}; what they printed is "
        "in the log of worker {}",
        host.name, host.ends, how, worker);
  }
  return is_first ? fmt::format("worker {} of {} ended: {}; it is started again, after growing pauses",
                                worker, host.name, how)
                  : "";
}

bool WorkerStarts::is_over() const { return !hosts_.empty() && std::ranges::all_of(hosts_, &Host::is_left); }

}  // namespace peclet::runner
