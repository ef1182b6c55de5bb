#include "runner/engines/usable_cores.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <vector>

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Machines with more cores than a cpu_set_t has bits need a larger set.
int cores_of_affinity() {
  for (std::size_t count = CPU_SETSIZE; count <= 1 << 16; count *= 2) {
    cpu_set_t* const set = CPU_ALLOC(count);
    if (set == nullptr) break;
    const std::size_t size = CPU_ALLOC_SIZE(count);
    const bool known = sched_getaffinity(0, size, set) == 0;
    const int cores = known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (known) return cores;
  }
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::optional<double> number_in(const fs::path& file) {
  double number = 0;
  return std::ifstream(file) >> number ? std::optional(number) : std::nullopt;
}

// Version 2: "QUOTA PERIOD" or "max PERIOD" [us]. Version 1: one file each, a quota below 0 for none.
std::optional<double> quota_of(const fs::path& group) {
  std::string quota;
  double period = 0;
  if (std::ifstream(group / "cpu.max") >> quota >> period) {
    return quota == "max" || period <= 0 ? std::nullopt
                                         : std::optional(std::strtod(quota.c_str(), nullptr) / period);
  }
  const std::optional<double> time = number_in(group / "cpu.cfs_quota_us"),
                              of = number_in(group / "cpu.cfs_period_us");
  return time && of && *time > 0 && *of > 0 ? std::optional(*time / *of) : std::nullopt;
}

}  // namespace

// "0::/system.slice/job.scope" of version 2, "4:cpu,cpuacct:/slurm/uid_1000/job_7" of version 1. In a
// container the files of its own group may lie at the root. Every group above limits, too.
std::optional<double> core_quota(const fs::path& root, const std::string& groups) {
  std::vector<std::pair<fs::path, fs::path>> places;  // where its kind is mounted, and the group in there
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = fs::path(line.substr(second + 1)).relative_path();
    if (controllers.empty()) places.emplace_back(root, group);
    if ((',' + controllers + ',').find(",cpu,") != std::string::npos) {
      places.emplace_back(root / controllers, group);
      places.emplace_back(root / "cpu", group);
    }
  }
  std::optional<double> least;
  for (auto& [mount, group] : places) {
    for (;; group = group.parent_path()) {
      if (const std::optional<double> quota = quota_of(mount / group))
        least = std::min(least.value_or(*quota), *quota);
      if (group.empty()) break;
    }
  }
  return least;
}

int usable_cores() {
  std::ifstream file("/proc/self/cgroup");
  const std::string groups{std::istreambuf_iterator<char>(file), {}};
  const int cores = cores_of_affinity();
  const std::optional<double> quota = core_quota("/sys/fs/cgroup", groups);
  return std::max(1, quota ? std::min(cores, static_cast<int>(std::ceil(*quota))) : cores);
}

}  // namespace peclet::runner
