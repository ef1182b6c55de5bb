// The folder of a campaign: where its files are.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/paths.h"

namespace peclet::runner {

// Names of everything below the folder; nothing here touches the disk.
class CampaignDirectory {
 public:
  explicit CampaignDirectory(fs::path root) : root_(std::move(root)) {}

  const fs::path& root() const { return root_; }
  fs::path database() const { return root_ / "campaign.db"; }
  fs::path lock() const { return root_ / "campaign.lock"; }
  fs::path spool() const { return root_ / "spool"; }
  fs::path rejected() const { return spool() / "rejected"; }
  // What realisations leave beside their results, until these are committed.
  fs::path left() const { return spool() / "files"; }
  fs::path checkpoints() const { return root_ / "checkpoints"; }
  fs::path failures() const { return root_ / "failures"; }
  fs::path logs() const { return root_ / "logs"; }
  fs::path backup() const { return root_ / "backup"; }
  // What people ask of the campaign, until its owner has carried it out.
  fs::path requests() const { return root_ / "requests"; }
  // What was in the way is kept here: of `peclet restore`, or of a run.
  fs::path aside() const { return root_ / "aside"; }
  // What realisations have left beside their results.
  fs::path files() const { return root_ / "files"; }
  fs::path run_log() const { return logs() / "peclet.log"; }

  // Of one seed, whoever runs it: the next attempt resumes what the last one left.
  fs::path checkpoint(const std::string& hash, int seed) const;
  // Of one attempt: a worker that outlived its owner never writes where a later attempt does.
  fs::path spool_file(const std::string& hash, int seed, std::int64_t attempt) const;
  // Of one seed; `point_id` tells the results of the engines apart that a scene has had.
  fs::path left_files(const std::string& hash, std::int64_t point_id, int seed) const;
  fs::path worker_log(int worker) const;

 private:
  fs::path root_;
};

// What an engine may keep beside a checkpoint: one file that grows, and that the checkpoint refers to. It
// goes wherever the checkpoint goes, and with it.
fs::path growing_beside(const fs::path& checkpoint);
bool is_growing(const fs::path& file);
// The checkpoint that a file is or belongs to.
fs::path checkpoint_of(const fs::path& file);

// `chosen`, or when that is empty "<stem>.peclet" beside the campaign file; an absolute path.
CampaignDirectory campaign_directory(const fs::path& campaign_file, const fs::path& chosen);

// Folders below its own that a running campaign needs.
std::vector<fs::path> folders_below(const CampaignDirectory& directory);

// Makes the folder and those below it. Throws fs::filesystem_error.
void create_folders(const CampaignDirectory& directory);

// A campaign works only in folders that nobody else can make lead elsewhere: those below its own must be
// folders, not links, and all must belong to the user of this process or to root. The campaign's folder
// itself is the one that its user has named, and may be a link. Throws UnsuitableFile naming the folder.
void require_own_folders(const CampaignDirectory& directory);

// A folder among temporary files, which goes with its owner.
class ScratchFolder {
 public:
  // `name` begins the folder's own. Throws std::system_error.
  explicit ScratchFolder(const std::string& name);
  ~ScratchFolder();
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// A new folder in aside/, for what is in the way.
fs::path make_folder_aside(const CampaignDirectory& directory);

// The kind of network file system that `path` (or the nearest folder above it that exists) is on, if it is on
// one.
std::optional<std::string> network_file_system(const fs::path& path);

// Returns a warning if the folder is on a file system that may be one of a network; "" if it is not.
std::string doubt_about_file_system(const fs::path& path);

// What lies in the folders of a campaign and is no file.
//
// Moves links, folders, FIFOs, sockets and devices out of the folders in which a run and its engines read,
// replace and remove files, into aside/: whatever they are, nothing waits for them or is stopped by them
// then. `tell` hears one sentence for each folder that had some. For the campaign's owner. Throws
// std::system_error.
void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell);

// Moves what has the name of a file or folder of ours, and is not of the `wanted` kind (as kind_of() says),
// out of the way: to PATH@aside, a name that no file of ours has. Returns a sentence about it; "" if nothing
// was in the way. Throws std::system_error.
std::string make_way(const fs::path& path, const std::string& wanted);

// What belongs to the program and lies beside it: adapters of other engines, the fits of the jamming point.

// The folder of the running program.
fs::path own_folder();

// `name` (relative, as in the source tree) among what was installed with the program, ../share/peclet of its
// folder; for a program that was not installed, in the source of its build tree. Nothing when it is not
// there. No other folder is asked: one that happens to be above the program may be anybody's.
std::optional<fs::path> own_file(const fs::path& name);

// The folders of the adapters that are there, in alphabetical order.
std::vector<fs::path> own_adapters();

}  // namespace peclet::runner
