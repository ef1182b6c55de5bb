#include "contract/own_folder.h"

namespace peclet {

namespace fs = std::filesystem;

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

std::string own_python() {
  const fs::path folder = own_folder(), interpreter = folder / "python3";
  // PEP 405: the file that marks a virtual environment.
  const bool is_environment = fs::exists(folder.parent_path() / "pyvenv.cfg") && fs::exists(interpreter);
  return is_environment ? interpreter.string() : "python3";
}

}  // namespace peclet
