// Folders into which an engine writes for its job.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "runner/engines/worker_pool.h"

namespace peclet::runner {

std::array<std::filesystem::path, 4> folders_of(const Job& job);

// The first of them that is not there or has no room; nothing if an engine can write in all of them. One that
// does not know how to wait for room may crash or give up instead, which is not its fault.
std::optional<std::filesystem::path> unwritable_folder(const Job& job);

}  // namespace peclet::runner
