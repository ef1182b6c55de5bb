#include "tests/runner/scripted_pool.h"

#include <csignal>
#include <stdexcept>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

void ScriptedPool::start(int worker) {
  at(worker) = Worker{true, std::nullopt};
  ++starts;
  if (says_hello) say(Hello{worker, plain_engine(identity)});
}

void ScriptedPool::assign(int worker, const Job& job) {
  if (!at(worker).alive || at(worker).job) throw std::logic_error("the worker is not free");
  at(worker).job = job;
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

void ScriptedPool::spool(int worker, double viscosity) const {
  const Job& about = job(worker);
  Json result = plain_result(about.point, about.seed, viscosity, identity);
  result["ending"]["message"] = noise(result_size, static_cast<std::uint32_t>(about.seed));
  write_durably(about.spool, result.dump());
}

void ScriptedPool::finish(int worker, double viscosity) {
  spool(worker, viscosity);
  const Job about = job(worker);
  at(worker).job.reset();
  say(ResultSpooled{worker, about.attempt, about.spool, sha256_of_file(about.spool)});
}

}  // namespace peclet::runner
