#include "runner/launch/launching.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <system_error>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/own_folder.h"
#include "contract/text.h"

namespace peclet::runner {
namespace {

// Asks for nothing, notices a dead link within a minute, and uses one connection for all workers of a host.
constexpr const char* secure_shell =
    "ssh -T -o BatchMode=yes -o ConnectTimeout=20 -o ServerAliveInterval=15 -o ServerAliveCountMax=3 "
    "-o ControlMaster=auto -o ControlPersist=60 -o ControlPath=~/.ssh/peclet-%C {host}";
constexpr int most_slots = 100'000;
constexpr std::uint64_t largest_file_of_hosts = 1 << 20;

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

EngineCommand near_end(const EngineCommand& engine, const std::string& launcher, double silence_seconds) {
  EngineCommand command = engine;
  command.program = own_folder() / "peclet";
  command.arguments = {"worker",
                       "--through",
                       launcher,
                       "--silence",
                       fmt::format("{}", silence_seconds),
                       "--",
                       engine.program.string()};
  command.arguments.insert(command.arguments.end(), engine.arguments.begin(), engine.arguments.end());
  return command;
}

// Returns host and slot of each worker, slot by slot. The hosts have as many slots at least.
std::vector<std::pair<std::string, int>> dealt_out(const std::vector<Host>& hosts, int workers) {
  std::vector<std::pair<std::string, int>> places;
  for (int slot = 0; std::ssize(places) < workers; ++slot) {
    for (const Host& host : hosts) {
      if (slot < host.slots && std::ssize(places) < workers) places.emplace_back(host.name, slot);
    }
  }
  return places;
}

}  // namespace

std::vector<Host> read_hosts(const fs::path& file) {
  static const std::regex form(
      R"(([A-Za-z0-9_][A-Za-z0-9._@-]*)(?::([0-9]+)|[ \t]+slots=([0-9]+)(?:[ \t].*)?)?)");
  std::vector<Host> hosts;
  std::string text;
  try {
    text = read_regular(file, largest_file_of_hosts);
  } catch (const std::system_error& error) {
    throw InputError(file.string(), "", error.code().message(), "must be a file with a host on each line");
  }
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    line.erase(line.find_last_not_of(" \t\r") + 1);
    line.erase(0, line.find_first_not_of(" \t"));
    if (line.empty()) continue;
    std::smatch parts;
    const bool is_host = std::regex_match(line, parts, form);
    const std::string slots = is_host ? parts[2].str() + parts[3].str() : "";
    const std::optional<int> count = slots.empty() ? std::optional(1) : number_in<int>(slots);
    if (!is_host || !count || *count < 1 || *count > most_slots) {
      throw InputError(file.string(), fmt::format("line {}", number), line,
                       "must be a host, as node1, node1 slots=8 or node1:8");
    }
    const auto known = std::ranges::find(hosts, parts[1].str(), &Host::name);
    if (known != hosts.end()) {
      known->slots = std::min(most_slots, known->slots + *count);
    } else {
      hosts.push_back({parts[1], *count});
    }
  }
  if (hosts.empty()) throw InputError(file.string(), "", "", "must have a line with a host");
  return hosts;
}

Launching read_launching(const std::string& launcher, const fs::path& hosts, int workers) {
  const bool names_host = launcher.find("{host}") != std::string::npos;
  if (hosts.empty() && names_host)
    throw InputError("", "--hosts", "absent", "must be given: --launch has {host}");
  if (!hosts.empty() && !launcher.empty() && !names_host)
    throw InputError("", "--launch", launcher, "must have {host}: --hosts is given");
  if (hosts.empty() && workers == 0)
    throw InputError("", "--workers", "absent", "must be given with --launch");
  Launching launching{launcher.empty() ? secure_shell : launcher, {}, workers};
  if (hosts.empty()) return launching;
  launching.hosts = read_hosts(hosts);
  std::int64_t slots = 0;
  for (const Host& host : launching.hosts) slots += host.slots;
  launching.workers =
      static_cast<int>(std::min<std::int64_t>({slots, most_slots, workers == 0 ? slots : workers}));
  return launching;
}

LaunchedWorkers launched_workers(const EngineCommand& engine, const Launching& launching, int workers,
                                 int threads, double silence_seconds) {
  const std::string launcher = replaced(launching.launcher, "{threads}", std::to_string(threads));
  LaunchedWorkers launched;
  const auto add = [&](const std::string& host, const std::string& name, int slot) {
    launched.commands.push_back(near_end(engine, replaced(launcher, "{host}", host), silence_seconds));
    // Cards are counted on each host.
    launched.commands.back().environment.push_back(fmt::format("PECLET_DEVICE_NUMBER={}", slot));
    launched.hosts.push_back(name);
  };
  if (launching.hosts.empty()) {
    for (int worker = 0; worker < workers; ++worker) add("", "--launch", 0);
  } else {
    for (const auto& [host, slot] : dealt_out(launching.hosts, workers)) add(host, host, slot);
  }
  return launched;
}

}  // namespace peclet::runner
