#include "runner/engines/cost_trial.h"

#include <fmt/format.h>

#include <chrono>
#include <variant>

#include "contract/frames.h"
#include "contract/json.h"
#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/engines/stop_signals.h"
#include "runner/engines/worker_process.h"
#include "runner/store/realisation_result.h"

namespace peclet::runner {
namespace {

using Clock = std::chrono::steady_clock;

class Trial {
 public:
  explicit Trial(const Json& scene) : scene_(scene) {}

  // False: it is over.
  bool hear(const WorkerEvent& event, WorkerPool& pool, const CampaignDirectory& directory) {
    if (std::holds_alternative<Hello>(event)) {
      pool.assign(0, job(directory));
      begun_ = Clock::now();
      return true;
    }
    if (const auto* progressed = std::get_if<Progressed>(&event)) return hear(*progressed);
    if (const auto* spooled = std::get_if<ResultSpooled>(&event)) {
      found_.seconds.reset();
      const Json ending = checked_part(read_json(spooled->spool), "")["ending"];
      const auto cause = ending["cause"].get<std::string>();
      if (has_results(cause)) {
        found_.seconds = since_begun();
      } else {
        found_.broke_off = plain(fmt::format("{}: {}", cause, ending.value("message", "")));
      }
    }
    return false;
  }
  bool is_late() const { return since_begun() > longest; }
  const CostTrial& found() const { return found_; }

 private:
  static constexpr double long_enough = 2, longest = 10;

  bool hear(const Progressed& progressed) {
    // Packing has steps of its own.
    if (progressed.step == 0 || progressed.steps == 0 || progressed.phase == 0) return true;
    if (!first_) {
      first_ = progressed.step;
      first_after_ = since_begun();
      return true;
    }
    const double measured = since_begun() - first_after_;
    const auto steps = static_cast<double>(progressed.step - *first_);
    if (steps <= 0) return true;
    found_.seconds = first_after_ + measured / steps * static_cast<double>(progressed.steps - *first_);
    return since_begun() < long_enough;
  }
  double since_begun() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  Job job(const CampaignDirectory& directory) const {
    Job job;
    job.attempt = 1;
    job.point = sha256(canonical_json(scene_));
    job.scene = scene_;
    job.checkpoint = directory.checkpoint(job.point, 0);
    job.spool = directory.spool_file(job.point, 0, 1);
    job.failures = directory.failures();
    job.progress_seconds = 0.2;
    return job;
  }

  const Json& scene_;
  Clock::time_point begun_ = Clock::now();
  std::optional<std::int64_t> first_;
  double first_after_ = 0;
  CostTrial found_;
};

}  // namespace

CostTrial try_cost(const Json& scene, const EngineCommand& command) {
  const ScratchFolder folder("peclet-trial");
  const CampaignDirectory directory(folder.path());
  create_folders(directory);
  StopSignals signals;
  ProcessPool pool(1, command, directory, signals);
  Trial trial(scene);
  pool.start(0);
  bool goes_on = true;
  while (goes_on && !trial.is_late()) {
    for (const WorkerEvent& event : pool.wait(std::chrono::milliseconds(100))) {
      goes_on = goes_on && trial.hear(event, pool, directory);
    }
  }
  pool.kill(0);
  return trial.found();
}

}  // namespace peclet::runner
