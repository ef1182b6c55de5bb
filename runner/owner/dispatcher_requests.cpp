// The dispatcher's part in what people ask for while it runs.
#include "runner/owner/dispatcher.h"

namespace peclet::runner {
namespace {

constexpr std::chrono::seconds request_interval{1};

}  // namespace

// While workers stop, requests wait for the next owner. During a pause they wait as everything does.
void Dispatcher::hear_requests() {
  if (stopping_ != Stopping::no || pause_.lasts() || clock_() - requests_heard_ < request_interval) return;
  requests_heard_ = clock_();
  try {
    if (settings_.requests()) find_running_seeds();
    request_waits_ = false;
  } catch (const std::exception& error) {
    const std::optional<Hindrance> hindrance = hindrance_in(error, root(), 1 << 20);
    if (!hindrance) throw;
    find_running_seeds();
    request_waits_ = true;
    begin_pause(*hindrance);
  }
}

void Dispatcher::find_running_seeds() {
  for (int number = 0; number < pool_.size(); ++number) {
    Worker& worker = at(number);
    bool wanted = true;
    for (std::optional<Assignment>* const about : {&worker.assignment, &worker.waiting}) {
      if (*about && !ledger_.find_place((*about)->given_seed)) wanted = false;
    }
    if (wanted || worker.watch.is_recalled()) continue;
    worker.watch.recall();
    pool_.drain(number);
  }
}

}  // namespace peclet::runner
