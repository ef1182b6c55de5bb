// Abbreviates the namespace std::filesystem in the runner.
#pragma once

#include <filesystem>

namespace peclet::runner {

namespace fs = std::filesystem;

}  // namespace peclet::runner
