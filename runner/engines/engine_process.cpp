#include "runner/engines/engine_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/errors.h"
#include "runner/campaign/campaign_file.h"
#include "runner/store/own_files.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

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
                       : fmt::format("must be a program; there is none at {}", program.string()));
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

// Of the pipe that an engine prints into, and the most that is read of it at a time.
constexpr int pipe_size = 1 << 18;

// Two descriptors that belong together; those that are left are closed.
struct Pair {
  std::array<int, 2> ends{-1, -1};
  Pair() = default;
  Pair& operator=(Pair&&) = delete;
  ~Pair() {
    for (const int end : ends) {
      if (end >= 0) close(end);
    }
  }
};

// As exec(3) wants them; valid as long as the words are.
std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// The settings of posix_spawn(3), which own memory.
class SpawnSettings {
 public:
  // What the engine prints goes to `output`.
  SpawnSettings(int socket, int output, const EngineCommand& command) {
    check(posix_spawn_file_actions_init(&actions_), "posix_spawn");
    check(posix_spawnattr_init(&attributes_), "posix_spawn");
    check(posix_spawn_file_actions_adddup2(&actions_, socket, 0), "posix_spawn");
    check(posix_spawn_file_actions_adddup2(&actions_, output, 1), "posix_spawn");
    check(posix_spawn_file_actions_adddup2(&actions_, 1, 2), "posix_spawn");
    if (!command.folder.empty()) {
      check(posix_spawn_file_actions_addchdir_np(&actions_, command.folder.c_str()), command.folder.c_str());
    }

    // The owner takes signals from a descriptor and has them blocked; the engine starts with the usual ones,
    // but for SIGPIPE: an engine that prints when its owner is gone must live to write its checkpoint.
    sigset_t blocked, all;
    sigemptyset(&blocked);
    for (const int number : command.blocked_signals) sigaddset(&blocked, number);
    sigfillset(&all);
    sigdelset(&all, SIGPIPE);
    check(posix_spawnattr_setsigmask(&attributes_, &blocked), "posix_spawn");
    check(posix_spawnattr_setsigdefault(&attributes_, &all), "posix_spawn");
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

  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

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

EngineProcess::EngineProcess(const EngineCommand& command) {
  Pair pipe;
  if (pipe2(pipe.ends.data(), O_CLOEXEC) != 0) check(errno, "pipe");
  fcntl(pipe.ends[0], F_SETFL, O_NONBLOCK);
  fcntl(pipe.ends[0], F_SETPIPE_SZ, pipe_size);  // a smaller one does it, too
  start(command, pipe.ends[1]);
  output_ = std::exchange(pipe.ends[0], -1);
}

EngineProcess::EngineProcess(const EngineCommand& command, const fs::path& log) {
  Pair file;
  file.ends[0] = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file.ends[0] < 0) check(errno, log.c_str());
  start(command, file.ends[0]);
}

void EngineProcess::start(const EngineCommand& command, int output) {
  Pair socket;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, socket.ends.data()) != 0) check(errno, "socketpair");
  const SpawnSettings settings(socket.ends[1], output, command);
  std::vector<std::string> words{command.program.string()};
  words.insert(words.end(), command.arguments.begin(), command.arguments.end());
  std::vector<std::string> variables = command.environment;
  for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
  const int error = posix_spawn(&process_, command.program.c_str(), settings.actions(), settings.attributes(),
                                pointers(words).data(), pointers(variables).data());
  if (error != 0) throw std::system_error(error, std::generic_category(), command.program.string());
  descriptor_ = std::exchange(socket.ends[0], -1);
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
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (std::chrono::steady_clock::now() < patience) {
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
  // Without taking the news away, so that it is true as long as the process is stopped.
  return process_ > 0 &&
         waitid(P_PID, static_cast<id_t>(process_), &about, WSTOPPED | WNOHANG | WNOWAIT) == 0 &&
         about.si_pid == process_;
}

std::optional<ExitStatus> EngineProcess::reap() {
  int status = 0;
  pid_t ended = 0;
  do {
    ended = waitpid(process_, &status, WNOHANG);
  } while (ended < 0 && errno == EINTR);
  if (ended == 0) return std::nullopt;
  if (ended < 0) check(errno, "waitpid");
  process_ = -1;
  return exit_status(status);
}

}  // namespace peclet::runner
