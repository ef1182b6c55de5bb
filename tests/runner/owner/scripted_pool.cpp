#include "tests/runner/owner/scripted_pool.h"

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <utility>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

void ScriptedPool::start(int worker) {
  at(worker) = Worker{true};
  ++starts;
  if (says_hello) say(Hello{worker, plain_engine(identity), takes_ahead, static_cast<int>(capacity)});
}

void ScriptedPool::assign(int worker, const Job& job) {
  Worker& about = at(worker);
  if (!about.alive || about.jobs.size() >= capacity + (takes_ahead ? 1 : 0)) {
    throw std::logic_error("the worker is not free");
  }
  about.jobs.push_back(job);
  assigned.push_back(job);
}

void ScriptedPool::drain(int worker) {
  if (!at(worker).alive || !leaves_when_drained) return;
  const std::vector<Job> jobs = at(worker).jobs;
  for (std::size_t place = 0; place < std::min(capacity, jobs.size()); ++place)
    say(Drained{worker, jobs[place].attempt, 5});
  at(worker) = Worker{};
  say(Exited{worker, {0, {}}});
}

void ScriptedPool::kill(int worker) {
  if (!at(worker).alive) return;
  at(worker) = Worker{};
  say(Exited{worker, {{}, SIGKILL}});
}

std::vector<WorkerEvent> ScriptedPool::wait(std::chrono::milliseconds patience) {
  if (said_.empty() && script) script();
  if (said_.empty()) now += patience;
  std::vector<WorkerEvent> events(said_.begin(), said_.end());
  said_.clear();
  for (const WorkerEvent& event : events) {
    if (const auto* exited = std::get_if<Exited>(&event)) at(exited->worker) = Worker{};
  }
  return events;
}

void ScriptedPool::spool(const Job& job, double viscosity) const {
  Json result = plain_result(job.point, job.seed, viscosity, identity);
  result["cost"]["wall_seconds"] = wall_seconds;
  result["ending"]["message"] = noise(result_size, static_cast<std::uint32_t>(job.seed));
  write_durably(job.spool, result.dump());
}

void ScriptedPool::begin_next(int worker, std::size_t place) {
  std::vector<Job>& jobs = at(worker).jobs;
  jobs.erase(jobs.begin() + static_cast<std::ptrdiff_t>(place));
}

void ScriptedPool::finish(int worker, double viscosity, std::size_t place) {
  const Job about = jobs(worker).at(place);
  spool(about, viscosity);
  begin_next(worker, place);
  say(ResultSpooled{worker, about.attempt, about.spool, sha256_of_file(about.spool)});
}

}  // namespace peclet::runner
