#include "runner/owner/after_commit.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <iterator>
#include <optional>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/text.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

namespace {

template <typename T>
void append(std::vector<T>& list, std::vector<T>& later) {
  std::move(later.begin(), later.end(), std::back_inserter(list));
}

// Gives the open file the further name `name` on the same file system; elsewhere copies it. This is the
// checked file, even if its own name was removed or given to another file.
void link_or_copy(const Descriptor& file, std::uint64_t bytes, const fs::path& name) {
  fs::remove_all(name);
  const std::string open_file = fmt::format("/proc/self/fd/{}", file.number());
  if (linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
  if (lseek(file.number(), 0, SEEK_SET) != 0) fail_to("cannot read what becomes", name);
  copy_durably(file.number(), bytes, name);
}

// Gives the file a waiting name in the folder of its place, which no file of a result has. After the commit
// it is only renamed, which needs no room.
void bring_home(const Descriptor& file, const FileRecord& record, const CampaignDirectory& directory,
                AfterCommit& after) {
  const fs::path place = record.place(directory), seed = place.parent_path();
  for (const fs::path& folder : {seed.parent_path(), seed}) {
    if (const std::string text = make_way(folder, "a folder"); !text.empty()) after.warn(text);
  }
  create_folders_durably(seed);
  const fs::path waiting = seed / ('@' + record.file.name);
  link_or_copy(file, record.file.bytes, waiting);
  after.keep(waiting, place);
}

// Brings a missing file of a known result to its place if the spool still has it.
void heal(const FileRecord& record, const fs::path& spool, const CampaignDirectory& directory,
          AfterCommit& after) {
  if (!record.kept || kind_of(record.place(directory)) == "a regular file") return;
  try {
    const auto& [name, bytes, sha256] = record.file;
    bring_home(open_left_file(left_file(spool, name), bytes, sha256), record, directory, after);
  } catch (const ResultError&) {  // the doctor names what is missing
  }
}

// Returns the attempt that writes files with this stem, as CampaignDirectory::spool_file() spells it.
std::optional<std::int64_t> attempt_of(const std::string& stem) {
  const std::size_t dash = stem.rfind('-');
  return dash == std::string::npos ? std::nullopt : number_in<std::int64_t>(stem.substr(dash + 1));
}

bool is_at_work(Database& database, const std::string& stem) {
  const std::optional<std::int64_t> attempt = attempt_of(stem);
  const std::optional<std::int64_t> process = attempt ? database.process_of(*attempt) : std::nullopt;
  return process && (kill(static_cast<pid_t>(*process), 0) == 0 || errno != ESRCH);
}

}  // namespace

void AfterCommit::add(AfterCommit&& later) {
  append(to_keep_, later.to_keep_);
  append(to_discard_, later.to_discard_);
  append(to_remove_, later.to_remove_);
  append(to_reject_, later.to_reject_);
  append(to_tell_, later.to_tell_);
}

void AfterCommit::carry_out(RunListener& listener, FileRemoval& removal) {
  const auto make_way_for_file = [&listener](const fs::path& path) {
    if (const std::string text = make_way(path, "a regular file"); !text.empty()) listener.warn(text);
  };
  for (const auto& [from, place] : to_keep_) {
    // A file may have been removed meanwhile; `peclet doctor` names it.
    if (!is_there(from)) continue;
    make_way_for_file(place);
    rename_durably(from, place);
  }
  for (const fs::path& checkpoint : to_discard_) {
    for (const fs::path& file : {checkpoint, growing_beside(checkpoint)}) {
      make_way_for_file(file);
      fs::remove(file);
    }
  }
  removal.add(to_remove_);
  for (const fs::path& file : to_reject_) peclet::runner::reject(home_of_spool_file(file), file);
  for (const Telling& telling : std::exchange(*this, {}).to_tell_) telling(listener);
}

void take_files(Connection& connection, const CampaignDirectory& directory, const RealisationResult& result,
                const fs::path& spool, const StoredResult& stored, bool keep, AfterCommit& after) {
  const std::vector<LeftFile> files = left_files(result.document);
  if (stored.is_new) {
    const std::vector<Descriptor> opened = open_files_in_spool(result.document, spool);
    for (std::size_t i = 0; i < files.size(); ++i) {
      store_file(connection, stored.point, result.seed, files[i], keep);
      const FileRecord record{result.point, stored.point, result.seed, files[i], keep};
      if (keep) bring_home(opened[i], record, directory, after);
    }
  } else if (!files.empty()) {
    for (const FileRecord& record : files_of_seed(connection, stored.point, result.seed))
      heal(record, spool, directory, after);
  }
  if (files.empty()) return;
  // Removes what is left of them: unwanted files, and those that were copied.
  for (const fs::path& file : left_files_of(spool)) after.remove(file);
}

void remove_files_of_the_dead(Database& database, const CampaignDirectory& directory) {
  for (const fs::path& file : whole_files(directory.left())) {
    const std::string name = file.filename().string();
    const std::size_t end = name.rfind('@');
    if (end == std::string::npos) continue;  // another program's
    const std::string stem = name.substr(0, end);
    // The process is checked first: what an ended process has written is there by now.
    if (is_at_work(database, stem) || is_there(directory.spool() / (stem + ".json"))) continue;
    std::error_code replaced;  // error if a folder took its place, which the next start moves aside
    fs::remove(file, replaced);
  }
}

}  // namespace peclet::runner
