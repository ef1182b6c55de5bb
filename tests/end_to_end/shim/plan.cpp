#include "tests/end_to_end/shim/plan.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

namespace peclet::drill {
namespace {

constexpr std::array<std::pair<const char*, Call>, 9> call_names{{{"create", Call::create},
                                                                  {"write", Call::write},
                                                                  {"truncate", Call::truncate},
                                                                  {"sync", Call::sync},
                                                                  {"rename", Call::rename},
                                                                  {"remove", Call::remove},
                                                                  {"send", Call::send},
                                                                  {"read", Call::read},
                                                                  {"allocation", Call::allocation}}};
constexpr std::array<std::pair<const char*, Action>, 8> action_names{{{"kill", Action::kill},
                                                                      {"cut", Action::cut},
                                                                      {"stop", Action::stop},
                                                                      {"wait", Action::wait},
                                                                      {"eio", Action::eio},
                                                                      {"enospc", Action::enospc},
                                                                      {"edquot", Action::edquot},
                                                                      {"fail", Action::fail}}};

// Ends the program: an invalid plan must not look like a passed drill.
[[noreturn]] void refuse(const std::string& why) {
  std::fprintf(stderr, "fault shim: %s\n", why.c_str());
  std::_Exit(99);
}

template <typename Names>
auto named(const Names& names, const std::string& name) {
  for (const auto& [known, value] : names) {
    if (name == known) return value;
  }
  refuse("PECLET_FAULT_PLAN: unknown word " + name);
}

struct Plan {
  bool concerns_us = false;
  bool any_change = true;
  Call call{};
  std::int64_t number = 0, times = 1;
  Action action = Action::kill;
  std::vector<std::string> paths;
  Board* board = nullptr;
};

Board* open_board() {
  const char* const path = std::getenv("PECLET_FAULT_BOARD");
  if (path == nullptr) return nullptr;
  const int descriptor = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC, 0));
  if (descriptor < 0) refuse(std::string("cannot open the board ") + path);
  void* const page = mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  if (page == MAP_FAILED) refuse(std::string("cannot map the board ") + path);
  return static_cast<Board*>(page);
}

Plan read_plan() {
  Plan plan;
  plan.board = open_board();
  const char* const text = std::getenv("PECLET_FAULT_PLAN");
  if (text == nullptr || plan.board == nullptr) return plan;
  std::map<std::string, std::string> words;
  std::istringstream entries(text);
  for (std::string entry; entries >> entry;) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) refuse("PECLET_FAULT_PLAN: no value in " + entry);
    words[entry.substr(0, equals)] = entry.substr(equals + 1);
  }
  const bool owner = std::strcmp(program_invocation_short_name, "peclet") == 0;
  plan.concerns_us = words["role"] == "any" || words["role"] == (owner ? "owner" : "worker");
  plan.any_change = words["call"] == "any";
  if (!plan.any_change) plan.call = named(call_names, words["call"]);
  plan.number = std::atoll(words["number"].c_str());
  plan.times = words.count("for") > 0 ? std::atoll(words["for"].c_str()) : 1;
  plan.action = named(action_names, words["action"]);
  std::istringstream paths(words["path"]);
  for (std::string path; std::getline(paths, path, ',');) plan.paths.push_back(path);
  return plan;
}

const Plan& plan() {
  static const Plan read = read_plan();
  return read;
}

void kill_children_of(pid_t parent) {
  const std::string process = std::to_string(parent);
  std::ifstream children("/proc/" + process + "/task/" + process + "/children");
  for (pid_t child = 0; children >> child;) {
    if (child != getpid()) kill(child, SIGKILL);
  }
}

// The owner is the parent of its workers. A worker whose owner has ended has a parent outside the drill.
void cut_power() {
  const bool owner = std::strcmp(program_invocation_short_name, "peclet") == 0;
  if (owner) {
    kill_children_of(getpid());
  } else {
    const pid_t parent = getppid();
    std::string name;
    std::ifstream("/proc/" + std::to_string(parent) + "/comm") >> name;
    if (name == "peclet") {
      kill_children_of(parent);
      kill(parent, SIGKILL);
    }
  }
  kill(getpid(), SIGKILL);
}

bool fits(const Plan& about, Call call, std::string_view path) {
  if (!about.concerns_us || about.board == nullptr) return false;
  const bool change = call != Call::read && call != Call::allocation;
  if (about.any_change ? !change : call != about.call) return false;
  return call == Call::allocation ||
         std::any_of(about.paths.begin(), about.paths.end(),
                     [path](const std::string& part) { return path.find(part) != std::string_view::npos; });
}

const char* name_of(Call call) {
  for (const auto& [name, known] : call_names) {
    if (known == call) return name;
  }
  return "?";
}

}  // namespace

int strike(Call call, std::string_view path) {
  const Plan& about = plan();
  if (!fits(about, call, path)) return 0;
  const std::int64_t number = ++about.board->calls;
  if (about.number == 0 || number < about.number || number >= about.number + about.times) return 0;
  if (about.board->off != 0) return 0;
  ++about.board->struck;
  about.board->process = getpid();
  std::snprintf(about.board->what, sizeof(about.board->what), "%s %.*s", name_of(call),
                static_cast<int>(path.size()), path.data());
  switch (about.action) {
    case Action::kill:
      kill(getpid(), SIGKILL);
      return 0;
    case Action::cut:
      cut_power();
      return 0;
    case Action::stop:
      kill(getpid(), SIGSTOP);
      return 0;
    case Action::wait:
      for (int waited = 0; about.board->off == 0; ++waited) {
        if (waited > 1000 * longest_wait_seconds) std::_Exit(98);
        usleep(1000);
      }
      return 0;
    case Action::eio:
      return EIO;
    case Action::enospc:
      return ENOSPC;
    case Action::edquot:
      return EDQUOT;
    case Action::fail:
      return ENOMEM;
  }
  return 0;
}

std::string path_of(int descriptor) {
  char path[PATH_MAX];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = readlink(link.c_str(), path, sizeof(path));
  return length < 0 ? std::string() : std::string(path, static_cast<std::size_t>(length));
}

std::int64_t next_record() { return plan().board == nullptr ? 0 : ++plan().board->sequence; }

}  // namespace peclet::drill
