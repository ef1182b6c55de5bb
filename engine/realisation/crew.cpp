#include "engine/realisation/crew.h"

#include <omp.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "engine/observables/scene_reading.h"

namespace peclet::engine {
namespace {

// Length of a turn.
constexpr std::chrono::milliseconds turn_length{100};

// Rounding of a sum of shares, far below a share.
constexpr double rounding_of_shares = 1e-9;

double seconds_of_thread() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Calls a function at the end of a block.
template <class Action>
struct AtEnd {
  Action action;
  ~AtEnd() { action(); }
};
template <class Action>
AtEnd(Action) -> AtEnd<Action>;

}  // namespace

Crew::Crew(Ensemble& ensemble, Device device)
    : ensemble_(ensemble),
      device_(device),
      packing_{std::max(1, omp_get_num_procs())},
      running_{packing_.free} {}

Crew::~Crew() {
  try {
    drain();
  } catch (const std::exception&) {  // of the ensemble: the jobs end by it too
  }
  for (Member& member : members_) member.thread.join();
}

void Crew::begin(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  Member& member = members_.emplace_back();
  try {
    member.thread = std::thread([this, &member, work = std::move(work)] {
      work();
      const std::lock_guard at_end(mutex_);
      member.has_ended = true;
      changed_.notify_all();
    });
  } catch (...) {
    members_.pop_back();
    throw;
  }
}

std::size_t Crew::active() {
  const std::lock_guard lock(mutex_);
  for (Member& member : members_) {
    if (member.has_ended) member.thread.join();
  }
  std::erase_if(members_, [](const Member& member) { return member.has_ended; });
  return members_.size();
}

bool Crew::take(Places& places) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return places.free > 0 || drains_; });
  if (drains_) return false;
  --places.free;
  return true;
}

bool Crew::drains() {
  const std::lock_guard lock(mutex_);
  return drains_;
}

void Crew::give_back(Places& places) {
  const std::lock_guard lock(mutex_);
  ++places.free;
  changed_.notify_all();
}

std::optional<Json> Crew::run(JobSpecification job, const JobEvents& events) {
  job.threads = 1;
  job.header.ensemble = ensemble_.name();
  const Scene scene = read_scene(job.scene, job.scene_name);
  const std::optional<InputError> refusal = ensemble_.refusal(scene, job.scene_name);
  if (refusal && device_ != Device::automatic) throw *refusal;
  Places& places = refusal ? running_ : packing_;
  if (!take(places)) return std::nullopt;
  bool has_place = true;
  const auto leave_place = [&] {
    if (std::exchange(has_place, false)) give_back(places);
  };
  const AtEnd leaving{leave_place};
  if (refusal) return run_job(job, events);

  job.header.in_ensemble = true;
  Stay stay{.simulation = nullptr,
            .events = &events,
            .share = 1 / static_cast<double>(ensemble_.capacity(scene)),
            .until = {},
            .ending = {}};
  const auto release = [&] {
    const std::lock_guard lock(mutex_);
    release_share(stay);
  };
  const AtEnd releasing{release};
  return run_job(job, events,
                 [&](Simulation& simulation, Clock::time_point until, double& processor_seconds) {
                   leave_place();
                   stay.simulation = &simulation;
                   stay.until = until;
                   std::optional<Ending> ending = steps_of(stay);
                   processor_seconds += std::exchange(stay.processor_seconds, 0);
                   if (!ending && job.checkpoint.empty() && drains()) {
                     throw std::runtime_error("was stopped, and has no place for a checkpoint");
                   }
                   return ending;
                 });
}

// Waits in the thread of a job until its realisation is at home again.
std::optional<Ending> Crew::steps_of(Stay& stay) {
  std::unique_lock lock(mutex_);
  if (drains_ && failure_.empty()) return std::nullopt;
  stay.is_over = false;
  if (failure_.empty()) {
    // One that was away for a checkpoint has its place still.
    stay.holds_share ? ready_.push_front(&stay) : ready_.push_back(&stay);
    changed_.notify_all();
    changed_.wait(lock, [&] { return stay.is_over; });
  }
  if (!failure_.empty()) throw std::runtime_error(failure_);
  return std::move(stay.ending);
}

void Crew::release_share(Stay& stay) {
  if (std::exchange(stay.holds_share, false)) taken_ -= stay.share;
}

bool Crew::next_fits() const {
  if (ready_.empty()) return false;
  const Stay& next = *ready_.front();
  return next.holds_share || taken_ + next.share <= 1 + rounding_of_shares;
}

// Adds realisations that are ready, in their order, as long as there is room.
void Crew::take_aboard() {
  while (true) {
    Stay* next = nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (!next_fits()) return;
      next = ready_.front();
      if (!std::exchange(next->holds_share, true)) taken_ += next->share;
      ready_.pop_front();
    }
    aboard_.push_back(next);
    ensemble_.add(*next->simulation);
  }
}

// Wakes the job of a realisation that is at home.
void Crew::hand_back(Stay& stay) {
  std::erase(aboard_, &stay);
  const std::lock_guard lock(mutex_);
  if (stay.ending) release_share(stay);
  stay.is_over = true;
  changed_.notify_all();
}

template <class Use>
void Crew::with_ensemble(const Use& use) {
  try {
    use();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
    drains_ = true;
    for (Stay* const stay : aboard_) stay->is_over = true;
    for (Stay* const stay : ready_) stay->is_over = true;
    aboard_.clear();
    ready_.clear();
    changed_.notify_all();
    throw;
  }
}

void Crew::turn() {
  with_ensemble([this] {
    take_aboard();
    if (aboard_.empty()) {
      std::unique_lock lock(mutex_);
      const auto has_ended = [](const Member& member) { return member.has_ended; };
      changed_.wait_for(lock, turn_length, [&] {
        return next_fits() || std::any_of(members_.begin(), members_.end(), has_ended);
      });
      return;
    }
    const double before = seconds_of_thread();
    std::vector<Ensemble::Ended> all_ended = ensemble_.advance(turn_length);
    const double of_each = (seconds_of_thread() - before) / static_cast<double>(aboard_.size());
    const Clock::time_point now = Clock::now();
    for (Stay* const stay : std::vector(aboard_)) {
      stay->processor_seconds += of_each;
      const auto ended = std::find_if(all_ended.begin(), all_ended.end(), [&](const Ensemble::Ended& one) {
        return one.simulation == stay->simulation;
      });
      if (ended != all_ended.end()) {
        stay->ending = std::move(ended->ending);
        hand_back(*stay);
      } else if (now > stay->until) {
        ensemble_.remove(*stay->simulation);
        hand_back(*stay);
      } else {
        const Simulation& simulation = *stay->simulation;
        stay->events->progress(
            progress_of(simulation, ensemble_.steps_made(simulation), ensemble_.net_strain(simulation)));
      }
    }
  });
}

void Crew::drain() {
  {
    const std::lock_guard lock(mutex_);
    drains_ = true;
    for (Stay* const stay : ready_) stay->is_over = true;
    ready_.clear();
    changed_.notify_all();
  }
  with_ensemble([this] {
    for (Stay* const stay : std::vector(aboard_)) {
      ensemble_.remove(*stay->simulation);
      hand_back(*stay);
    }
  });
}

}  // namespace peclet::engine
