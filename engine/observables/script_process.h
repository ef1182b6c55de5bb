// Runs a user's Python script in a process of its own and speaks with it.
//
// The process is the python3 in PATH with script_driver.py, which is part of this program. Both send frames
// (contract/frames.h) through a socket. Standard output of the script goes to standard error of the engine.
// The process ends with the ScriptProcess, and also if the engine is killed.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "contract/durable_file.h"
#include "contract/frames.h"

namespace peclet::engine {

// The script gave no answer that can be used; what() says why: "mine.py, line 12: ZeroDivisionError: ...".
class ScriptError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Script {
  std::string name, text;                  // of the file
  std::string scene;                       // which the script may read, as JSON
  std::chrono::duration<double> patience;  // for each answer
};

class ScriptProcess {
 public:
  // Starts the process and lets it read the script. Throws ScriptError, std::system_error.
  explicit ScriptProcess(const Script& script);
  ~ScriptProcess();
  ScriptProcess(const ScriptProcess&) = delete;
  ScriptProcess& operator=(const ScriptProcess&) = delete;

  // Returns descriptions of what the script measures, as the script names them.
  const Json& quantities() const { return quantities_; }

  // Sends a message, followed by `bytes`, and returns the answer. Throws ScriptError; and std::runtime_error
  // if the process was killed from outside, which says nothing about the script.
  Json ask(const Json& message, std::string_view bytes = {});

  // Returns the processor time of the process since the last call [s].
  double take_seconds() { return std::exchange(seconds_, 0); }

 private:
  void send(std::string_view bytes, std::chrono::steady_clock::time_point deadline);
  // Throw for a process that has closed its socket, or is silent for too long.
  [[noreturn]] void explain_end();
  [[noreturn]] void explain_silence() const;
  void end();

  std::string name_;
  std::chrono::milliseconds patience_;
  pid_t process_ = -1;
  std::optional<Descriptor> socket_;
  FrameChannel channel_{-1};
  double seconds_ = 0, total_seconds_ = 0;  // not taken; in all
  Json quantities_;
};

// Returns the text of script_driver.py.
const char* script_driver();

}  // namespace peclet::engine
