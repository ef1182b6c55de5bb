#include "runner/engines/engine_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/errors.h"
#include "contract/exec_words.h"
#include "contract/own_folder.h"
#include "runner/campaign/campaign_file.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

namespace {
using Clock = std::chrono::steady_clock;

bool is_file(const fs::path& path) {
  std::error_code impossible;  // a loop of links, a name that is too long
  return fs::is_regular_file(path, impossible);
}

bool is_program(const fs::path& path) { return is_file(path) && access(path.c_str(), X_OK) == 0; }

[[noreturn]] void refuse_engine(const fs::path& campaign_file, const std::string& name,
                                const fs::path& program) {
  throw InputError(campaign_file.string(), "/engine/0", name,
                   is_file(program)
                       ? fmt::format("may not be executed: `chmod +x {}`", program.string())
                       : fmt::format("must be a program; there is no file {}", program.string()));
}

std::vector<fs::path> search_path() {
  std::vector<fs::path> folders{own_folder()};
  const char* const path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
  }
  const std::vector<fs::path> adapters = own_adapters();
  folders.insert(folders.end(), adapters.begin(), adapters.end());
  return folders;
}

// Throws std::system_error, which names what was being done, unless `error` is 0.
void check(int error, const std::string& doing) {
  if (error != 0) throw std::system_error(error, std::generic_category(), doing);
}

// The size of the pipe that an engine prints into, and the most that is read of it at a time [bytes].
constexpr int pipe_size = 1 << 18;

struct Ends {
  Descriptor first, second;
};

Ends make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) check(errno, "pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// Returns a file in memory with the text, to be read from its beginning; a pipe might be too small.
Descriptor file_with(const std::string& text) {
  Descriptor file(memfd_create("input", MFD_CLOEXEC));
  if (file.number() < 0) check(errno, "memfd_create");
  write_all(file.number(), text, "memfd_create");
  lseek(file.number(), 0, SEEK_SET);
  return file;
}

// The settings of posix_spawn(3), which own memory. The child gets a process group of its own, and the
// default handling of signals that this process has blocked.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output, int errors) {
    check(posix_spawn_file_actions_init(&actions_), "posix_spawn");
    check(posix_spawnattr_init(&attributes_), "posix_spawn");
    const std::array streams{input, output, errors};
    for (int stream = 0; stream < 3; ++stream) {
      check(posix_spawn_file_actions_adddup2(&actions_, streams.at(static_cast<std::size_t>(stream)), stream),
            "posix_spawn");
    }
    sigemptyset(&blocked_);
    sigfillset(&usual_);
    check(posix_spawnattr_setpgroup(&attributes_, 0), "posix_spawn");
    check(posix_spawnattr_setflags(&attributes_,
                                   POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF),
          "posix_spawn");
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings& operator=(SpawnSettings&&) = delete;

  void run_in(const fs::path& folder) {
    check(posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str()), folder.string());
  }
  void block(int signal) { sigaddset(&blocked_, signal); }
  // Leaves the signal ignored if this process ignores it.
  void inherit(int signal) { sigdelset(&usual_, signal); }

  // Starts the program words[0], found on PATH, with these variables beside those of this process.
  pid_t spawn(std::vector<std::string> words, std::vector<std::string> variables = {}) {
    check(posix_spawnattr_setsigmask(&attributes_, &blocked_), "posix_spawn");
    check(posix_spawnattr_setsigdefault(&attributes_, &usual_), "posix_spawn");
    for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
    pid_t process = -1;
    check(posix_spawnp(&process, words.at(0).c_str(), &actions_, &attributes_, exec_words(words).data(),
                       exec_words(variables).data()),
          words[0]);
    return process;
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
  sigset_t blocked_, usual_;
};

// Returns false at the end of the stream.
bool read_into(std::string& text, int descriptor) {
  std::array<char, 4096> bytes{};
  const ssize_t count = read(descriptor, bytes.data(), bytes.size());
  if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

// Reads both streams until they end. Returns false if `deadline` passes first.
bool read_to_end(int output, int errors, CommandAnswer& answer, Clock::time_point deadline) {
  std::array<pollfd, 2> watched{{{output, POLLIN, 0}, {errors, POLLIN, 0}}};
  while (watched[0].fd >= 0 || watched[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    if (poll(watched.data(), watched.size(), static_cast<int>(left)) < 0 && errno != EINTR) {
      check(errno, "poll");
    }
    if (watched[0].revents != 0 && !read_into(answer.output, output)) watched[0].fd = -1;
    if (watched[1].revents != 0 && !read_into(answer.errors, errors)) watched[1].fd = -1;
  }
  return true;
}

// Returns how the process ended, or nothing if it still runs; `options` are those of waitpid(2).
std::optional<ExitStatus> wait_for(pid_t process, int options) {
  int status = 0;
  pid_t ended = -1;
  do {
    ended = waitpid(process, &status, options);
  } while (ended < 0 && errno == EINTR);
  if (ended < 0) check(errno, "waitpid");
  return ended == 0 ? std::nullopt : std::optional(exit_status(status));
}

// True if this process ignores the signal, as SIGHUP under nohup. Such a signal must not be blocked, because
// a blocked signal is kept even if it is to be ignored.
bool is_ignored(int number) {
  struct sigaction present {};
  return sigaction(number, nullptr, &present) == 0 && present.sa_handler == SIG_IGN;
}

}  // namespace

EngineCommand resolve_engine(const Campaign& campaign, const fs::path& campaign_file) {
  const std::string& name = campaign.engine.at(0);
  const fs::path home = home_of(campaign_file);
  EngineCommand command{{}, {campaign.engine.begin() + 1, campaign.engine.end()}, home, {}};
  if (name.find('/') != std::string::npos) {
    command.program = (home / name).lexically_normal();
    if (is_program(command.program)) return command;
    refuse_engine(campaign_file, name, command.program);
  }
  for (const fs::path& folder : search_path()) {
    command.program = fs::absolute(folder / name);
    if (is_program(command.program)) return command;
  }
  throw InputError(campaign_file.string(), "/engine/0", name,
                   "must be a program beside peclet, on PATH, or one of peclet's adapters");
}

void choose_device(const std::string& device) {
  if (device == "none") {
    unsetenv("PECLET_DEVICE");
  } else if (!device.empty()) {
    setenv("PECLET_DEVICE", device.c_str(), 1);
  }
}

int visible_cards(const fs::path& devices) {
  if (const char* const named = std::getenv("CUDA_VISIBLE_DEVICES")) {
    const std::string_view names = named;
    return names.empty() || names.front() == '-' ? 0 : static_cast<int>(std::ranges::count(names, ',')) + 1;
  }
  constexpr std::string_view prefix = "nvidia";
  int cards = 0;
  std::error_code unreadable;
  for (const fs::directory_entry& entry : fs::directory_iterator(devices, unreadable)) {
    const std::string name = entry.path().filename().string();
    const bool is_card = name.size() > prefix.size() && name.starts_with(prefix) &&
                         name.find_first_not_of("0123456789", prefix.size()) == name.npos;
    cards += is_card ? 1 : 0;
  }
  return cards;
}

EngineProcess::EngineProcess(const EngineCommand& command) {
  Ends pipe = make_pipe();
  fcntl(pipe.first.number(), F_SETFL, O_NONBLOCK);
  fcntl(pipe.first.number(), F_SETPIPE_SZ, pipe_size);  // may fail: a smaller pipe works, too
  start(command, pipe.second.number());
  output_ = pipe.first.take();
}

EngineProcess::EngineProcess(const EngineCommand& command, const Descriptor& output) {
  start(command, output.number());
}

void EngineProcess::start(const EngineCommand& command, int output) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) check(errno, "socketpair");
  Descriptor ours(ends[0]);
  const Descriptor its(ends[1]);
  SpawnSettings settings(its.number(), output, output);
  if (!command.folder.empty()) settings.run_in(command.folder);
  for (const int number : command.blocked_signals) settings.block(number);
  // An engine that prints after its owner is gone must live to write its checkpoint.
  settings.inherit(SIGPIPE);
  std::vector<std::string> words{command.program.string()};
  words.insert(words.end(), command.arguments.begin(), command.arguments.end());
  process_ = settings.spawn(std::move(words), command.environment);
  descriptor_ = ours.take();
}

EngineProcess::EngineProcess(EngineProcess&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      output_(std::exchange(other.output_, -1)),
      process_(std::exchange(other.process_, -1)) {}

EngineProcess::~EngineProcess() {
  hang_up();
  leave_or_be_killed();
  if (output_ >= 0) close(output_);
}

void EngineProcess::leave_or_be_killed() {
  if (process_ < 0) return;
  const auto patience = Clock::now() + std::chrono::seconds(5);
  while (Clock::now() < patience) {
    if (reap()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  kill();
  waitpid(process_, nullptr, 0);
}

std::string EngineProcess::printed() {
  std::string text(pipe_size, '\0');
  const ssize_t count = output_ >= 0 ? read(output_, text.data(), text.size()) : 0;
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

void EngineProcess::hang_up() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

void EngineProcess::kill() const {
  if (process_ > 0) ::kill(process_, SIGKILL);
}

bool EngineProcess::is_stopped() const {
  siginfo_t about{};
  // WNOWAIT leaves the state to be reported again, so that this is true as long as the process is stopped.
  return process_ > 0 &&
         waitid(P_PID, static_cast<id_t>(process_), &about, WSTOPPED | WNOHANG | WNOWAIT) == 0 &&
         about.si_pid == process_;
}

std::optional<ExitStatus> EngineProcess::reap() {
  const std::optional<ExitStatus> ending = wait_for(process_, WNOHANG);
  if (ending) process_ = -1;
  return ending;
}

std::string CommandAnswer::complaint() const {
  std::string said = errors.empty() ? output : errors;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  std::replace(said.begin(), said.end(), '\n', ' ');
  const std::string how = timed_out ? "no answer in time" : to_string(ending);
  return said.empty() ? how : fmt::format("{}: {}", how, said);
}

CommandAnswer run_command(const std::vector<std::string>& words, std::chrono::seconds patience,
                          const std::string& input) {
  const Descriptor text = file_with(input);
  Ends output = make_pipe(), errors = make_pipe();
  SpawnSettings settings(text.number(), output.second.number(), errors.second.number());
  const pid_t process = settings.spawn(words);
  output.second.close();
  errors.second.close();
  CommandAnswer answer;
  if (!read_to_end(output.first.number(), errors.first.number(), answer, Clock::now() + patience)) {
    answer.timed_out = true;
    kill(-process, SIGKILL);
  }
  answer.ending = *wait_for(process, 0);
  return answer;
}

PipedProgram start_piped(std::vector<std::string> words) {
  Ends input = make_pipe(), output = make_pipe();
  SpawnSettings settings(input.first.number(), output.second.number(), STDERR_FILENO);
  const pid_t process = settings.spawn(std::move(words));
  return {std::move(input.second), std::move(output.first), process};
}

StopSignals::StopSignals(int one_more) {
  sigemptyset(&stopping_);
  for (const int number : {SIGINT, SIGTERM, one_more}) sigaddset(&stopping_, number);
  if (!is_ignored(SIGHUP)) sigaddset(&stopping_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &stopping_, nullptr);
  descriptor_ = signalfd(-1, &stopping_, SFD_NONBLOCK | SFD_CLOEXEC);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

// Takes the signals that came late, so that they do not kill the process when they are no longer blocked.
StopSignals::~StopSignals() {
  while (take()) {
  }
  close(descriptor_);
  pthread_sigmask(SIG_UNBLOCK, &stopping_, nullptr);
}

bool StopSignals::take() {
  signalfd_siginfo about{};
  return read(descriptor_, &about, sizeof(about)) == static_cast<ssize_t>(sizeof(about));
}

bool StopSignals::wait(std::chrono::milliseconds patience) {
  pollfd watched{descriptor_, POLLIN, 0};
  return poll(&watched, 1, static_cast<int>(patience.count())) > 0 && take();
}

}  // namespace peclet::runner
