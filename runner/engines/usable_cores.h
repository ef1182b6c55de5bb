// How many processor cores this process may use.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace peclet::runner {

// Returns the cores of the affinity mask (taskset, Slurm's cpusets), or fewer where a control group limits
// processor time to fewer; at least 1.
int usable_cores();

// The processor time, in cores, to which the control groups limit a process whose /proc/self/cgroup reads
// `groups`, below `root`, where they are mounted (/sys/fs/cgroup); nothing if they do not.
std::optional<double> core_quota(const std::filesystem::path& root, const std::string& groups);

}  // namespace peclet::runner
