#include "runner/engines/command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>

#include "runner/engines/engine_process.h"

namespace peclet::runner {
namespace {

using Clock = std::chrono::steady_clock;

// The reading end of a pipe, and the writing end until the child has it.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) check(errno, "pipe");
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe& operator=(Pipe&&) = delete;

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_end(std::size_t end) {
    if (ends_.at(end) >= 0) close(ends_.at(end));
    ends_.at(end) = -1;
  }
  // False at the end of the stream.
  bool read_into(std::string& text) const {
    std::array<char, 4096> bytes{};
    const ssize_t count = read(ends_[0], bytes.data(), bytes.size());
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

// A file in memory that holds the text, to be read from its beginning. A pipe might fill up before the
// program reads.
class TextFile {
 public:
  explicit TextFile(const std::string& text) : file_(memfd_create("input", MFD_CLOEXEC)) {
    if (file_ < 0) check(errno, "memfd_create");
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t count = pwrite(file_, text.data() + at, text.size() - at, static_cast<off_t>(at));
      if (count < 0) check(errno, "memfd_create");
      at += static_cast<std::size_t>(count);
    }
  }
  ~TextFile() { close(file_); }
  TextFile& operator=(TextFile&&) = delete;

  int reading() const { return file_; }

 private:
  int file_;
};

pid_t start(const std::vector<std::string>& words, const TextFile& input, const Pipe& output,
            const Pipe& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  check(posix_spawn_file_actions_init(&actions), "posix_spawn");
  check(posix_spawnattr_init(&attributes), "posix_spawn");
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawn_file_actions_adddup2(&actions, input.reading(), 0);
  posix_spawn_file_actions_adddup2(&actions, output.writing(), 1);
  posix_spawn_file_actions_adddup2(&actions, errors.writing(), 2);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  arguments.reserve(copies.size() + 1);
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error = posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  check(error, words.at(0).c_str());
  return process;
}

// Reads both streams until they end; false when that takes longer than until `deadline`.
bool read_to_end(const Pipe& output, const Pipe& errors, CommandAnswer& answer, Clock::time_point deadline) {
  std::array<pollfd, 2> watched{{{output.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
  while (watched[0].fd >= 0 || watched[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    if (poll(watched.data(), watched.size(), static_cast<int>(left)) < 0 && errno != EINTR) {
      check(errno, "poll");
    }
    if (watched[0].revents != 0 && !output.read_into(answer.output)) watched[0].fd = -1;
    if (watched[1].revents != 0 && !errors.read_into(answer.errors)) watched[1].fd = -1;
  }
  return true;
}

ExitStatus wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) check(errno, "waitpid");
  }
  return exit_status(status);
}

}  // namespace

std::string CommandAnswer::complaint() const {
  std::string said = errors.empty() ? output : errors;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  std::replace(said.begin(), said.end(), '\n', ' ');
  const std::string how = timed_out ? "no answer in time" : to_string(ending);
  return said.empty() ? how : fmt::format("{}: {}", how, said);
}

CommandAnswer run_command(const std::vector<std::string>& words, std::chrono::seconds patience,
                          const std::string& input) {
  const TextFile text(input);
  Pipe output, errors;
  const pid_t process = start(words, text, output, errors);
  output.close_end(1);
  errors.close_end(1);
  CommandAnswer answer;
  if (!read_to_end(output, errors, answer, Clock::now() + patience)) {
    answer.timed_out = true;
    kill(-process, SIGKILL);
  }
  answer.ending = wait_for(process);
  return answer;
}

}  // namespace peclet::runner
