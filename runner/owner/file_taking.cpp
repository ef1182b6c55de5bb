#include "runner/owner/file_taking.h"

#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <optional>
#include <string>

#include "contract/descriptor.h"
#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "runner/database/file_book.h"
#include "runner/folder/spool.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

dev_t device_of(const fs::path& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) fail_to("cannot examine", path);
  return about.st_dev;
}

// After the commit it only changes its name, which needs no room. So what lies on another file system is
// copied before that, under a name that no file of a result has.
void bring_home(const fs::path& from, const FileRecord& record, const CampaignDirectory& directory,
                AfterCommit& after) {
  const fs::path place = record.place(directory);
  create_folders_durably(place.parent_path());
  if (device_of(from) == device_of(place.parent_path())) return after.keep(from, place);
  const fs::path copy = place.parent_path() / ('@' + record.file.name);
  copy_regular(from, copy, largest_left_file);
  after.keep(copy, place);
}

// The attempt that writes files with this stem, as CampaignDirectory::spool_file() spells it.
std::optional<std::int64_t> attempt_of(const std::string& stem) {
  const std::size_t dash = stem.rfind('-');
  std::int64_t attempt = 0;
  if (dash == std::string::npos) return std::nullopt;
  const char* const end = stem.data() + stem.size();
  const auto read = std::from_chars(stem.data() + dash + 1, end, attempt);
  if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  return attempt;
}

bool is_at_work(Connection& connection, const std::string& stem) {
  const std::optional<std::int64_t> attempt = attempt_of(stem);
  if (!attempt) return false;
  Statement known(connection, "SELECT process FROM attempt WHERE attempt_id = ?");
  known.bind(*attempt);
  return known.step() && (kill(static_cast<pid_t>(known.integer(0)), 0) == 0 || errno != ESRCH);
}

}  // namespace

void take_files(Connection& connection, const CampaignDirectory& directory, const RealisationResult& result,
                const fs::path& spool, const StoredResult& stored, bool keep, AfterCommit& after) {
  const std::vector<LeftFile> files = left_files(result.document);
  if (stored.is_new) {
    check_files_in_spool(result.document, spool);
    for (const LeftFile& file : files) store_file(connection, stored.point, result.seed, file, keep);
  }
  if (files.empty()) return;
  for (const FileRecord& record : files_of_seed(connection, stored.point, result.seed)) {
    const fs::path from = left_file(spool, record.file.name);
    // Of a result that is known, what is not in its place yet.
    const bool is_wanted = record.kept && (stored.is_new || !is_there(record.place(directory)));
    if (!is_wanted) continue;
    if (!stored.is_new && !fault_of_file(from, record.file.bytes, record.file.sha256).empty()) continue;
    bring_home(from, record, directory, after);
  }
  // What is then left of them: unwanted ones, and those that were copied.
  for (const fs::path& file : left_files_of(spool)) after.remove(file);
}

void remove_files_of_the_dead(Connection& connection, const CampaignDirectory& directory) {
  for (const fs::path& file : whole_files(directory.left())) {
    const std::string name = file.filename().string();
    const std::size_t end = name.rfind('@');
    if (end == std::string::npos) continue;  // not ours
    const std::string stem = name.substr(0, end);
    // In this order: what a process that is gone has written is there by now.
    if (is_at_work(connection, stem) || is_there(directory.spool() / (stem + ".json"))) continue;
    fs::remove(file);
  }
}

}  // namespace peclet::runner
