#include "runner/store/own_files.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// A build tree, with its programs in bin/, says in CMakeCache.txt where its source is.
std::optional<fs::path> source_of_build() {
  constexpr std::string_view entry = "CMAKE_HOME_DIRECTORY:INTERNAL=";
  std::ifstream cache(own_folder().parent_path() / "CMakeCache.txt");
  for (std::string line; std::getline(cache, line);) {
    if (line.starts_with(entry)) return line.substr(entry.size());
  }
  return std::nullopt;
}

}  // namespace

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

std::optional<fs::path> own_file(const fs::path& name) {
  const fs::path installed = own_folder().parent_path() / "share" / "peclet" / name;
  if (fs::exists(installed)) return installed;
  const std::optional<fs::path> source = source_of_build();
  if (source && fs::exists(*source / name)) return *source / name;
  return std::nullopt;
}

std::vector<fs::path> own_adapters() {
  std::vector<fs::path> folders;
  if (const std::optional<fs::path> adapters = own_file("adapters")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(*adapters)) {
      if (entry.is_directory()) folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace peclet::runner
