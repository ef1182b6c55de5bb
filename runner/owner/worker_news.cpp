#include "runner/owner/worker_news.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

namespace peclet::runner {
namespace {

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

// Returns the unbooked progress that `later` replaces, if its worker has said nothing since but the progress
// of other jobs; otherwise null.
Progressed* superseded(std::vector<WorkerEvent>& news, const Progressed& later) {
  const auto last = std::find_if(news.rbegin(), news.rend(), [&](const WorkerEvent& event) {
    const auto* const progress = std::get_if<Progressed>(&event);
    return worker_of(event) == later.worker && (progress == nullptr || progress->job == later.job);
  });
  auto* const progress = last == news.rend() ? nullptr : std::get_if<Progressed>(&*last);
  return progress != nullptr && progress->job == later.job && progress->phase == later.phase ? progress
                                                                                             : nullptr;
}

}  // namespace

void WorkerNews::add(WorkerEvent event) {
  const auto* const progress = std::get_if<Progressed>(&event);
  if (Progressed* const before = progress != nullptr ? superseded(events_, *progress) : nullptr) {
    *before = *progress;
  } else {
    events_.push_back(std::move(event));
  }
}

std::ptrdiff_t WorkerNews::exits() const {
  return std::ranges::count_if(
      events_, [](const WorkerEvent& event) { return std::holds_alternative<Exited>(event); });
}

std::uint64_t WorkerNews::bytes() const {
  std::uint64_t bytes = 1 << 20;
  for (const WorkerEvent& event : events_) {
    const auto* const result = std::get_if<ResultSpooled>(&event);
    std::error_code absent;
    const std::uintmax_t size = result == nullptr ? 0 : fs::file_size(result->spool, absent);
    if (result != nullptr && !absent) bytes += 2 * size;
  }
  return bytes;
}

}  // namespace peclet::runner
