#include "tests/runner/owner/scripted_pool.h"

#include <csignal>
#include <stdexcept>
#include <utility>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

void ScriptedPool::start(int worker) {
  at(worker) = Worker{true, std::nullopt, std::nullopt};
  ++starts;
  if (says_hello) say(Hello{worker, plain_engine(identity), takes_ahead});
}

void ScriptedPool::assign(int worker, const Job& job) {
  Worker& about = at(worker);
  if (!about.alive || (about.job && (!takes_ahead || about.waiting))) {
    throw std::logic_error("the worker is not free");
  }
  (about.job ? about.waiting : about.job) = job;
  assigned.push_back(job);
}

void ScriptedPool::drain(int worker) {
  if (!at(worker).alive || !leaves_when_drained) return;
  if (at(worker).job) say(Drained{worker, at(worker).job->attempt, 5});
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

void ScriptedPool::begin_next(int worker) {
  at(worker).job = std::exchange(at(worker).waiting, std::nullopt);
}

void ScriptedPool::finish(int worker, double viscosity) {
  const Job about = job(worker);
  spool(about, viscosity);
  begin_next(worker);
  say(ResultSpooled{worker, about.attempt, about.spool, sha256_of_file(about.spool)});
}

}  // namespace peclet::runner
