#include "runner/owner/folder_watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/campaign/quoting.h"
#include "runner/store/backups.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds interval{1};

}  // namespace

FolderWatch::FolderWatch(const CampaignDirectory& directory, const OwnerLock& lock, Database& database,
                         RunListener& listener)
    : directory_(directory), lock_(lock), database_(database), listener_(listener) {}

bool FolderWatch::attend(Time now) {
  if (now - last_ < interval) return false;
  last_ = now;
  refuse_move();
  refuse_deletion();
  require_own_folders(directory_);
  return mend_folders();
}

void FolderWatch::refuse_move() const {
  const std::optional<fs::path> folder = lock_.folder();
  std::error_code absent;
  if (!folder || fs::equivalent(*folder, directory_.root(), absent)) return;
  throw IntegrityError(
      fmt::format("{}: was moved to {} while the campaign ran, which stops here; everything that was "
                  "committed is there: move it back and run again, or go on there with --directory {}",
                  directory_.root().string(), folder->string(), shell_word(folder->string())));
}

void FolderWatch::refuse_deletion() const {
  if (lock_.folder() && fs::exists(directory_.database())) return;
  const fs::path saved = free_name(directory_.root().string() + ".saved.db");
  copy_database(database_.connection(), saved);
  throw IntegrityError(fmt::format(
      "{}: was deleted while the campaign ran, which stops here; all {} results in it were saved in {}: put "
      "them back with `peclet restore {} {}`",
      directory_.database().string(), extent_of(database_.connection()).results, saved.string(),
      shell_word(saved.string()), shell_word(directory_.root().string())));
}

bool FolderWatch::mend_folders() const {
  std::vector<std::string> gone;
  for (const fs::path& folder : folders_below(directory_)) {
    // One that went with the folder above it is not named.
    if (kind_of(folder).empty() && !kind_of(folder.parent_path()).empty())
      gone.push_back(folder.lexically_relative(directory_.root()).string() + "/");
  }
  if (gone.empty()) return false;
  try {
    create_folders(directory_);
  } catch (const fs::filesystem_error& error) {
    if (!means_machine_fault(error.code().value())) throw;
    return false;  // looked at again in a second
  }
  listener_.warn(
      fmt::format("{}: somebody deleted {} while the campaign runs; made anew: the database keeps what it "
                  "has, and a seed whose checkpoint or unbooked result was there runs again",
                  directory_.root().string(), fmt::join(gone, ", ")));
  return true;
}

}  // namespace peclet::runner
