// Finds what was installed together with the running program.
#pragma once

#include <filesystem>
#include <string>

namespace peclet {

// Returns the folder of the running program.
std::filesystem::path own_folder();

// Returns the Python interpreter for scripts and figures: that of the virtual environment in which the
// program was installed, or else "python3", which is searched for in PATH.
std::string own_python();

}  // namespace peclet
