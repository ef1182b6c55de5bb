#include "contract/provenance.h"

#include <fstream>

#include "contract/sha256.h"
#include "provenance_facts.h"  // generated at build time by cmake/write_provenance_facts.cmake

namespace peclet {

namespace {

std::string processor_name() {
  std::ifstream information("/proc/cpuinfo");
  for (std::string line; std::getline(information, line);) {
    if (!line.starts_with("model name")) continue;
    const auto value = line.find_first_not_of(" \t", line.find(':') + 1);
    if (value != std::string::npos) return line.substr(value);
  }
  return "unknown";
}

Json collect() {
  const std::string commit = facts::git_commit;
  return {{"version", version()},
          {"git_commit", commit.empty() ? Json("unknown") : Json(commit)},
          {"git_dirty", commit.empty() ? Json(nullptr) : Json(facts::git_dirty)},
          {"binary_sha256", sha256_of_file("/proc/self/exe")},
          {"compiler", facts::compiler},
          {"flags", facts::flags},
          {"build_type", facts::build_type},
          {"cpu", processor_name()}};
}

}  // namespace

std::string version() { return facts::version; }

const Json& provenance() {
  static const Json collected = collect();
  return collected;
}

}  // namespace peclet
