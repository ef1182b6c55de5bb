#include "engine/observables/script_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>
#include <vector>

#include "contract/exec_words.h"
#include "contract/own_folder.h"

namespace peclet::engine {
namespace {

using Monotonic = std::chrono::steady_clock;

constexpr int socket_of_driver = 3, cannot_be_run = 127;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

// Becomes python3 with the driver, in a child of fork(2). Only calls that are safe there.
[[noreturn]] void become_driver(int socket, pid_t parent, char* const* words, char* const* variables) {
  // A group of its own: Ctrl-C at a terminal is for the engine, which saves a checkpoint.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (dup2(socket, socket_of_driver) < 0 || fcntl(socket_of_driver, F_SETFD, 0) < 0 || dup2(nothing, 0) < 0)
    _exit(cannot_be_run);
  dup2(2, 1);
  close_range(socket_of_driver + 1, ~0U, 0);
  execvpe(words[0], words, variables);
  _exit(cannot_be_run);
}

}  // namespace

ScriptProcess::ScriptProcess(const Script& script)
    : name_(script.name), patience_(std::chrono::ceil<std::chrono::milliseconds>(script.patience)) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  socket_.emplace(ends[0]);
  Descriptor other(ends[1]);
  channel_ = FrameChannel(socket_->number());
  std::vector<std::string> words = {own_python(), "-c", script_driver()};
  // The first of two equal names counts. The order of sets must not change from process to process.
  std::vector<std::string> variables = {"PYTHONHASHSEED=0"};
  for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
  const std::vector<char*> arguments = exec_words(words), environment = exec_words(variables);
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) fail("fork");
  if (process_ == 0) become_driver(other.number(), parent, arguments.data(), environment.data());
  other.close();
  try {
    quantities_ =
        ask({{"type", "script"}, {"name", script.name}, {"text", script.text}, {"scene", script.scene}})
            .at("quantities");
  } catch (...) {
    end();
    throw;
  }
}

ScriptProcess::~ScriptProcess() { end(); }

void ScriptProcess::end() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
}

void ScriptProcess::send(std::string_view bytes, Monotonic::time_point deadline) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_->number(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EPIPE || errno == ECONNRESET) {
      explain_end();
    } else if (errno == EAGAIN) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Monotonic::now()).count();
      if (left <= 0) explain_silence();
      pollfd waiting{socket_->number(), POLLOUT, 0};
      poll(&waiting, 1, static_cast<int>(left));
    } else if (errno != EINTR) {
      fail("cannot send a frame to the script");
    }
  }
}

Json ScriptProcess::ask(const Json& message, std::string_view bytes) {
  const Monotonic::time_point deadline = Monotonic::now() + patience_;
  send(encode_frame(message), deadline);
  send(bytes, deadline);
  Json answer;
  switch (channel_.receive(answer, patience_)) {
    case FrameChannel::Status::nothing:
      explain_silence();
    case FrameChannel::Status::closed:
      explain_end();
    case FrameChannel::Status::message:
      break;
  }
  const double total = answer.at("seconds").get<double>();
  seconds_ += total - std::exchange(total_seconds_, total);
  if (answer.at("type") == "fault") throw ScriptError(answer.at("message").get<std::string>());
  return answer;
}

void ScriptProcess::explain_silence() const {
  throw ScriptError(fmt::format("{}: gave no answer within {:g} s, its /measure/patience", name_,
                                std::chrono::duration<double>(patience_).count()));
}

void ScriptProcess::explain_end() {
  int status = 0;
  const Monotonic::time_point deadline = Monotonic::now() + patience_;
  while (waitpid(process_, &status, WNOHANG) == 0) {
    if (Monotonic::now() > deadline) explain_silence();  // it closed the socket and runs on
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == cannot_be_run)
    throw ScriptError("scripts need python3 with NumPy in PATH, and python3 cannot be run");
  if (WIFEXITED(status))
    throw ScriptError(fmt::format("{}: ended its process with exit code {}", name_, WEXITSTATUS(status)));
  const int signal = WTERMSIG(status);
  const std::string how = fmt::format("{}: its process was ended by signal {} ({})", name_, signal,
                                      sigdescr_np(signal) != nullptr ? sigdescr_np(signal) : "unknown");
  if (signal == SIGKILL || signal == SIGTERM) throw std::runtime_error(how);
  throw ScriptError(how);
}

}  // namespace peclet::engine
