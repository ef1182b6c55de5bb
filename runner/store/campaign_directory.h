// CampaignDirectory names the files in the folder of a campaign; it does not touch the disk.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/paths.h"

namespace peclet::runner {

class CampaignDirectory {
 public:
  explicit CampaignDirectory(fs::path root) : root_(std::move(root)) {}

  const fs::path& root() const { return root_; }
  fs::path database() const { return root_ / "campaign.db"; }
  fs::path lock() const { return root_ / "campaign.lock"; }
  fs::path spool() const { return root_ / "spool"; }
  fs::path rejected() const { return spool() / "rejected"; }
  // Files that realisations leave beside their results, until these are committed.
  fs::path left() const { return spool() / "files"; }
  fs::path checkpoints() const { return root_ / "checkpoints"; }
  fs::path failures() const { return root_ / "failures"; }
  fs::path logs() const { return root_ / "logs"; }
  fs::path backup() const { return root_ / "backup"; }
  // Requests to the campaign's owner that are not carried out yet.
  fs::path requests() const { return root_ / "requests"; }
  // Things that were in the way of `peclet restore` or of a run.
  fs::path aside() const { return root_ / "aside"; }
  // Files that realisations have left beside their results.
  fs::path files() const { return root_ / "files"; }
  fs::path run_log() const { return logs() / "peclet.log"; }

  // Checkpoint of a seed, shared by all attempts: the next one resumes what the last one left.
  fs::path checkpoint(const std::string& hash, int seed) const;
  // Spool file of one attempt: a worker that outlived its owner never writes where a later attempt does.
  fs::path spool_file(const std::string& hash, int seed, std::int64_t attempt) const;
  // Folder of a seed's files; `point_id` distinguishes the engines that a scene has had.
  fs::path left_files(const std::string& hash, std::int64_t point_id, int seed) const;
  fs::path worker_log(int worker) const;

 private:
  fs::path root_;
};

// Returns the growing file that an engine may keep beside a checkpoint, which refers to it. It is moved and
// removed together with the checkpoint.
fs::path growing_beside(const fs::path& checkpoint);
bool is_growing(const fs::path& file);
// Returns the checkpoint that a file is or belongs to.
fs::path checkpoint_of(const fs::path& file);

// Returns `chosen`, or if that is empty "<stem>.peclet" beside the campaign file, as an absolute path.
CampaignDirectory campaign_directory(const fs::path& campaign_file, const fs::path& chosen);

// Returns the subfolders that a running campaign needs.
std::vector<fs::path> folders_below(const CampaignDirectory& directory);

// Makes the folder and those below it. Throws fs::filesystem_error.
void create_folders(const CampaignDirectory& directory);

// Checks that no other user can redirect the campaign's folders: subfolders must be folders, not links, and
// all must belong to the user of this process or to root. The campaign's folder itself may be a link. Throws
// UnsuitableFile naming the folder.
void require_own_folders(const CampaignDirectory& directory);

// ScratchFolder is a folder among temporary files that is removed with its object.
class ScratchFolder {
 public:
  // `name` is the beginning of the folder's name. Throws std::system_error.
  explicit ScratchFolder(const std::string& name);
  ~ScratchFolder();
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Makes a new folder in aside/, for what is in the way, and returns it.
fs::path make_folder_aside(const CampaignDirectory& directory);

// Returns the kind of network file system that `path`, or the nearest existing folder above it, is on;
// nothing if it is not on one.
std::optional<std::string> network_file_system(const fs::path& path);

// Returns a warning if the folder may be on a network file system; "" if not.
std::string doubt_about_file_system(const fs::path& path);

// Moves links, folders, FIFOs, sockets and devices into aside/ out of the folders in which a run and its
// engines read, replace and remove files, so that none of them can block or stop a run. `tell` gets one
// sentence for each folder that had some. For the campaign's owner. Throws std::system_error.
void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell);

// Moves `path` to PATH@aside, a name that no file of a campaign has, unless it is absent or of the `wanted`
// kind (as kind_of() says). Returns a sentence about it; "" if nothing was moved. Throws std::system_error.
std::string make_way(const fs::path& path, const std::string& wanted);

// Files installed with the program: adapters of other engines, the fit of the jamming point.

// Returns the file `name` (relative, as in the source tree) that was installed with the program, in
// ../share/peclet of its folder; for a program that was not installed, the file in the source of its build
// tree. Returns nothing if it is not there. No other folder is searched, because a folder above the program
// may belong to another user.
std::optional<fs::path> own_file(const fs::path& name);

// Returns the folders of the adapters that are there, sorted.
std::vector<fs::path> own_adapters();

}  // namespace peclet::runner
