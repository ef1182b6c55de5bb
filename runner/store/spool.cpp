#include "runner/store/spool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <regex>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// write_durably() names its temporary files NAME.PROCESS.COUNT.tmp. Nothing: not such a name.
std::optional<int> writer_of(const fs::path& temporary) {
  const std::string process = temporary.stem().stem().extension().string();  // ".PROCESS"
  const auto number = process.empty() ? std::nullopt : number_in<int>(process.substr(1));
  return number && *number > 0 ? number : std::nullopt;
}

}  // namespace

RealisationResult read_spool_file(const fs::path& path, const std::string& sha256) {
  std::string text;
  try {
    text = read_regular(path, largest_result);
  } catch (const UnsuitableFile& error) {
    throw ResultError(fmt::format("it {} and {}", error.value(), error.allowed()));
  } catch (const std::system_error& error) {
    if (means_machine_fault(error.code().value())) throw;
    throw ResultError(error.what());
  }
  if (!sha256.empty() && peclet::sha256(text) != sha256) {
    throw ResultError("its bytes do not have the hash that the engine gave");
  }
  return parse_result(text);
}

bool belongs_to_another(const fs::path& path, const RealisationResult& result) {
  // As CampaignDirectory::spool_file() spells it, apart from the attempt.
  static const std::regex ours("([0-9a-f]{16})-([0-9]{6,9})-[0-9]+[.]json");
  const std::string name = path.filename().string();
  std::smatch parts;
  if (!std::regex_match(name, parts, ours)) return false;
  return parts[1] != result.point.substr(0, 16) || std::stoi(parts[2]) != result.seed;
}

CampaignDirectory home_of_spool_file(const std::filesystem::path& path) {
  return CampaignDirectory(path.parent_path().parent_path());
}

std::vector<fs::path> spool_files(const CampaignDirectory& directory) {
  return whole_files(directory.spool());
}

std::vector<fs::path> whole_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (kind_of(folder).empty()) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const bool is_regular = entry.symlink_status().type() == fs::file_type::regular;
    if (is_regular && entry.path().extension() != ".tmp") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

fs::path reject(const CampaignDirectory& directory, const fs::path& path) {
  std::vector<fs::path> files = left_files_of(path);
  files.push_back(path);
  fs::path target;
  fs::create_directories(directory.rejected());
  for (const fs::path& file : files) {
    target = free_name(directory.rejected() / file.filename());
    std::error_code error;
    fs::rename(file, target, error);
    const bool is_gone = error == std::errc::no_such_file_or_directory;
    if (error && !is_gone) throw fs::filesystem_error("cannot move", file, target, error);
  }
  return target;
}

std::vector<fs::path> unfinished_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".tmp" || kind_of(entry.path()) == "a folder") continue;
    const std::optional<int> writer = writer_of(entry.path());
    if (writer && kill(*writer, 0) != 0 && errno == ESRCH) files.push_back(entry.path());
  }
  return files;
}

void remove_unfinished_files(const fs::path& folder) {
  for (const fs::path& file : unfinished_files(folder)) {
    // SQLite may have been at it.
    for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(file.string() + suffix);
  }
}

}  // namespace peclet::runner
