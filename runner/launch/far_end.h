// FarEnd is the end of a launched worker on the machine on which its engine runs.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "runner/engines/engine_process.h"
#include "runner/launch/carried_files.h"

namespace peclet::runner {

// A folder for the files of jobs, in TMPDIR or /tmp. It is removed at the end, or by a later far end if this
// one is killed.
class FarFolder {
 public:
  FarFolder();
  ~FarFolder();
  FarFolder& operator=(FarFolder&&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  int lock_ = -1;  // descriptor, locked while the folder is in use
};

class FarEnd {
 public:
  // The near end is at standard input and output. From now on what is printed goes to standard error.
  FarEnd();
  // Serves the near end until the engine has ended; returns the exit code.
  int run();

 private:
  using Clock = FrameLink::Clock;

  struct FarJob {
    CarriedJob near;
    fs::file_time_type checkpoint_time{};  // of the checkpoint that the near end has
    std::uint64_t growing_sent = 0;        // bytes of the growing file that the near end has
  };

  void hear_near_end();
  void begin(const Json& frame);
  void take_job(Json frame);
  void hear_engine();
  void pass_on(Json frame);
  void send_result(const Json& frame);
  void send_files(std::int64_t number);
  void name_state_at_home(std::int64_t number, Json& frame);
  // Returns the paths of a job here; its folders exist.
  CarriedJob here(std::int64_t number);
  // Sends the checkpoint if it is another one than last time.
  void send_checkpoint(std::int64_t number, FarJob& job);
  void send_checkpoints();
  void end_job(std::int64_t number);
  void listen();
  // Lets the engine write its checkpoints and go.
  void hang_up();
  // Sends what the engine left behind, and how it ended.
  int conclude(const ExitStatus& ending);

  FarFolder folder_;
  FrameLink near_;
  StopSignals signals_;
  std::optional<EngineProcess> engine_;
  std::optional<FrameLink> frames_;  // of the engine
  Outbox outbox_;
  Inbox inbox_;
  std::map<std::int64_t, FarJob> jobs_;
  std::map<std::int64_t, fs::path> places_;  // folder of each job
  std::vector<fs::path> free_places_;        // empty folders, for the next jobs
  std::chrono::duration<double> silence_{60};
  Clock::time_point checkpoints_seen_{};
  std::optional<int> stopped_by_;  // signal
  std::optional<Clock::time_point> hung_up_;
};

}  // namespace peclet::runner
