// Processes: one running engine, whose standard input is one end of a socket pair; outside commands that are
// run to their end; signals that stop this process.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/store/blame.h"

namespace peclet::runner {

// An engine does not start, or does not live until it is given work. Exit code 1.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct EngineCommand {
  fs::path program;
  std::vector<std::string> arguments;  // without the program
  fs::path folder;                     // in which it runs
  // Signals that the engine never hears, because whoever sends them to all processes of a job means its
  // owner, which then asks the engine by frames.
  std::vector<int> blocked_signals{};
  std::vector<std::string> environment{};  // "NAME=value", beside that of this process
};

// Finds campaign.engine[0]: absolute, or with a slash relative to the campaign file's folder; else beside the
// running program, else on PATH, else among the program's own adapters. It runs in the campaign file's
// folder, so that names among its arguments mean the same wherever peclet is started. Throws InputError at
// /engine/0 of `campaign_file`.
EngineCommand resolve_engine(const Campaign& campaign, const fs::path& campaign_file);

// Movable owner of the process and of our end of its socket.
class EngineProcess {
 public:
  // Starts the engine in a process group of its own, so that a Ctrl-C at the terminal reaches only its owner.
  // What it prints goes into a pipe, to be read with printed(), or into the file `output`. Our end of the
  // socket is close-on-exec, so an owner's death is the end of file that tells the engine to checkpoint and
  // leave. Throws std::system_error.
  explicit EngineProcess(const EngineCommand& command);
  EngineProcess(const EngineCommand& command, const Descriptor& output);
  // Closes the socket, waits briefly for the engine to leave by itself, then kills it.
  ~EngineProcess();
  EngineProcess(EngineProcess&& other) noexcept;
  EngineProcess& operator=(EngineProcess&&) = delete;

  int descriptor() const { return descriptor_; }
  pid_t process() const { return process_; }

  // What it has printed since, at most some hundred kilobytes at a time; never waits.
  std::string printed();

  // Closes our end of the socket: the engine checkpoints and leaves.
  void hang_up();
  // SIGKILL. The ending is still to be reaped.
  void kill() const;
  // Whether it is stopped now (SIGSTOP and the like).
  bool is_stopped() const;
  // How it ended, once it has. Requires that it has not said so before: afterwards the process no longer
  // exists.
  std::optional<ExitStatus> reap();

 private:
  void start(const EngineCommand& command, int output);

  void leave_or_be_killed();

  int descriptor_ = -1;
  int output_ = -1;     // our end of the pipe
  pid_t process_ = -1;  // -1: reaped
};

// An outside command, run to its end: what it printed and how it left.

struct CommandAnswer {
  ExitStatus ending;
  bool timed_out = false;  // it was killed with its children, and what it did is unknown
  std::string output, errors;
  bool succeeded() const { return !timed_out && ending.status == 0; }
  // Why it did not succeed, on one line: "exit status 1: Unable to contact slurm controller".
  std::string complaint() const;
};

// Runs a program (found on PATH) in a process group of its own, so that a Ctrl-C at the terminal does not cut
// it off between doing something and saying so. Its standard input is `input`. Throws std::system_error if
// the program cannot be started.
CommandAnswer run_command(const std::vector<std::string>& words, std::chrono::seconds patience,
                          const std::string& input = "");

// SIGINT, SIGTERM and SIGHUP (the terminal or connection is gone), and one more if it is given, as something
// to poll for: from construction to destruction they are blocked in this thread and read from a descriptor
// instead. Threads that are started meanwhile inherit that. SIGHUP is left alone where it is ignored, as
// under nohup.
class StopSignals {
 public:
  explicit StopSignals(int one_more = SIGTERM);
  ~StopSignals();
  StopSignals& operator=(StopSignals&&) = delete;
  int descriptor() const { return descriptor_; }
  // Takes one signal that has come, if any.
  bool take();
  // Waits for one at most so long, and takes it.
  bool wait(std::chrono::milliseconds patience);

 private:
  sigset_t stopping_{};
  int descriptor_ = -1;
};

}  // namespace peclet::runner
