// What belongs to the program and lies beside it: adapters of other engines, the fits of the jamming point.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace peclet::runner {

// The folder of the running program.
std::filesystem::path own_folder();

// `name` (relative, as in the source tree) among what was installed with the program, ../share/peclet of its
// folder; for a program that was not installed, in the source of its build tree. Nothing when it is not
// there. No other folder is asked: one that happens to be above the program may be anybody's.
std::optional<std::filesystem::path> own_file(const std::filesystem::path& name);

// The folders of the adapters that are there, in alphabetical order.
std::vector<std::filesystem::path> own_adapters();

}  // namespace peclet::runner
