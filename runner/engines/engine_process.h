// Processes and signals: a running engine, whose standard input is one end of a socket pair; commands that
// are run to their end; signals that stop this process.
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

// Thrown if an engine does not start, or ends before it is given work. Exit code 1.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct EngineCommand {
  fs::path program;
  std::vector<std::string> arguments;  // without the program
  fs::path folder;                     // in which it runs
  // Signals that are blocked in the engine. A batch system sends them to all processes of a job; the engine's
  // owner receives them and asks the engine by frames.
  std::vector<int> blocked_signals{};
  std::vector<std::string> environment{};  // "NAME=value", beside that of this process
};

// Finds the program campaign.engine[0]. A name with a slash is absolute or relative to the campaign file's
// folder. Any other name is looked for beside the running program, then on PATH, then among the program's own
// adapters. The engine runs in the campaign file's folder, wherever peclet is started, so that file names
// among its arguments keep their meaning. Throws InputError at /engine/0 if the program is not found.
EngineCommand resolve_engine(const Campaign& campaign, const fs::path& campaign_file);

// Sets PECLET_DEVICE for the engines of this process: "auto" or "cuda". "none" unsets it, and "" leaves it as
// it is.
void choose_device(const std::string& device);
// Returns the number of NVIDIA cards that CUDA_VISIBLE_DEVICES names or, unless it is set, of their files in
// `devices`.
int visible_cards(const fs::path& devices = "/dev");

// A running engine. Movable; owns the process and this end of its socket.
class EngineProcess {
 public:
  // Starts the engine in a process group of its own, so that a Ctrl-C at the terminal reaches only its owner.
  // The engine's output goes into a pipe, to be read with printed(), or into the file `output`. This end of
  // the socket is close-on-exec: if the owner dies, the engine reads an end of file, saves a checkpoint and
  // exits. Throws std::system_error.
  explicit EngineProcess(const EngineCommand& command);
  EngineProcess(const EngineCommand& command, const Descriptor& output);
  // Closes the socket, waits briefly for the engine to leave by itself, then kills it.
  ~EngineProcess();
  EngineProcess(EngineProcess&& other) noexcept;
  EngineProcess& operator=(EngineProcess&&) = delete;

  int descriptor() const { return descriptor_; }
  pid_t process() const { return process_; }

  // Returns the engine's output since the last call, at most 256 KiB, without waiting.
  std::string printed();

  // Closes this end of the socket, so that the engine saves a checkpoint and exits.
  void hang_up();
  // Sends SIGKILL. reap() is still to be called.
  void kill() const;
  // True if the process is stopped now, as by SIGSTOP.
  bool is_stopped() const;
  // Returns how the process ended, or nothing if it still runs. Must not be called again after it has
  // returned a status, because the process no longer exists.
  std::optional<ExitStatus> reap();

 private:
  void start(const EngineCommand& command, int output);

  void leave_or_be_killed();

  int descriptor_ = -1;
  int output_ = -1;     // this end of the pipe
  pid_t process_ = -1;  // -1: reaped
};

// The output and the exit status of a command that was run to its end.
struct CommandAnswer {
  ExitStatus ending;
  bool timed_out = false;  // it was killed with its children, and what it did is unknown
  std::string output, errors;
  bool succeeded() const { return !timed_out && ending.status == 0; }
  // Returns why the command failed, on one line: "exit status 1: Unable to contact slurm controller".
  std::string complaint() const;
};

// Runs a program (found on PATH) to its end, and kills it after `patience`. It has a process group of its
// own, so that a Ctrl-C at the terminal does not interrupt it. Its standard input is `input`. Throws
// std::system_error if the program cannot be started.
CommandAnswer run_command(const std::vector<std::string>& words, std::chrono::seconds patience,
                          const std::string& input = "");

// A program that runs with a pipe to its standard input and one from its standard output, in a process group
// of its own. It shares the standard error of this process.
struct PipedProgram {
  Descriptor input, output;  // this process's ends
  pid_t process;
};
// Starts a program that is found on PATH. Throws std::system_error.
PipedProgram start_piped(std::vector<std::string> words);

// Receives SIGINT, SIGTERM, SIGHUP (the terminal or connection is gone) and `one_more` through a descriptor
// that can be polled. While the object lives, they are blocked in this thread and in threads that it starts.
// SIGHUP is left alone if it is ignored, as under nohup.
class StopSignals {
 public:
  explicit StopSignals(int one_more = SIGTERM);
  ~StopSignals();
  StopSignals& operator=(StopSignals&&) = delete;
  int descriptor() const { return descriptor_; }
  // Takes one signal that has come. Returns false if there is none.
  bool take();
  // Waits at most `patience` for a signal, and takes it. Returns false if none came.
  bool wait(std::chrono::milliseconds patience);

 private:
  sigset_t stopping_{};
  int descriptor_ = -1;
};

}  // namespace peclet::runner
