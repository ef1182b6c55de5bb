// The folder of a campaign: where its files are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace peclet::runner {

// Names of everything below the folder; nothing here touches the disk.
class CampaignDirectory {
 public:
  explicit CampaignDirectory(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path database() const { return root_ / "campaign.db"; }
  std::filesystem::path lock() const { return root_ / "campaign.lock"; }
  std::filesystem::path spool() const { return root_ / "spool"; }
  std::filesystem::path rejected() const { return spool() / "rejected"; }
  // What realisations leave beside their results, until these are committed.
  std::filesystem::path left() const { return spool() / "files"; }
  std::filesystem::path checkpoints() const { return root_ / "checkpoints"; }
  std::filesystem::path failures() const { return root_ / "failures"; }
  std::filesystem::path logs() const { return root_ / "logs"; }
  std::filesystem::path backup() const { return root_ / "backup"; }
  // What people ask of the campaign, until its owner has carried it out.
  std::filesystem::path requests() const { return root_ / "requests"; }
  // What was in the way is kept here: of `peclet restore`, or of a run.
  std::filesystem::path aside() const { return root_ / "aside"; }
  // What realisations have left beside their results.
  std::filesystem::path files() const { return root_ / "files"; }
  std::filesystem::path run_log() const { return logs() / "peclet.log"; }

  // Of one seed, whoever runs it: the next attempt resumes what the last one left.
  std::filesystem::path checkpoint(const std::string& hash, int seed) const;
  // Of one attempt: a worker that outlived its owner never writes where a later attempt does.
  std::filesystem::path spool_file(const std::string& hash, int seed, std::int64_t attempt) const;
  // Of one seed; `point_id` tells the results of the engines apart that a scene has had.
  std::filesystem::path left_files(const std::string& hash, std::int64_t point_id, int seed) const;
  std::filesystem::path worker_log(int worker) const;

 private:
  std::filesystem::path root_;
};

// What an engine may keep beside a checkpoint: one file that grows, and that the checkpoint refers to. It
// goes wherever the checkpoint goes, and with it.
std::filesystem::path growing_beside(const std::filesystem::path& checkpoint);
bool is_growing(const std::filesystem::path& file);
// The checkpoint that a file is or belongs to.
std::filesystem::path checkpoint_of(const std::filesystem::path& file);

// `chosen`, or when that is empty "<stem>.peclet" beside the campaign file; an absolute path.
CampaignDirectory campaign_directory(const std::filesystem::path& campaign_file,
                                     const std::filesystem::path& chosen);

// Folders below its own that a running campaign needs.
std::vector<std::filesystem::path> folders_below(const CampaignDirectory& directory);

// Makes the folder and those below it. Throws std::filesystem::filesystem_error.
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

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// A new folder in aside/, for what is in the way.
std::filesystem::path make_folder_aside(const CampaignDirectory& directory);

// The kind of network file system that `path` (or the nearest folder above it that exists) is on, if it is on
// one.
std::optional<std::string> network_file_system(const std::filesystem::path& path);

// Returns a warning if the folder is on a file system that may be one of a network; "" if it is not.
std::string doubt_about_file_system(const std::filesystem::path& path);

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
std::string make_way(const std::filesystem::path& path, const std::string& wanted);

}  // namespace peclet::runner
