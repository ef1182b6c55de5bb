#include "runner/store/campaign_directory.h"

#include <fmt/format.h>
#include <sys/vfs.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/own_folder.h"
#include "runner/campaign/quoting.h"

namespace peclet::runner {

namespace {

// Sixteen hexadecimal digits tell the points of a campaign apart and keep names readable.
std::string stem(const std::string& hash, int seed) {
  return fmt::format("{}-{:06}", hash.substr(0, 16), seed);
}

// statfs(2) magic numbers of file systems whose locks or fsync cannot be trusted between machines.
constexpr std::array<std::pair<unsigned long, const char*>, 11> network_kinds{{{0x6969, "NFS"},
                                                                               {0x517b, "SMB"},
                                                                               {0xff534d42, "CIFS"},
                                                                               {0xfe534d42, "SMB2"},
                                                                               {0x00c36400, "Ceph"},
                                                                               {0x0bd00bd0, "Lustre"},
                                                                               {0x47504653, "GPFS"},
                                                                               {0x19830326, "BeeGFS"},
                                                                               {0x5346414f, "AFS"},
                                                                               {0x6b414653, "AFS"},
                                                                               {0xaad7aaea, "PanFS"}}};
// File systems whose number does not say whether they are on a network.
constexpr std::array<std::pair<unsigned long, const char*>, 8> doubtful_kinds{
    {{0x65735546, "FUSE (sshfs, DAOS, Gluster and others)"},
     {0x01021997, "9P (a virtual machine's host)"},
     {0x20030528, "OrangeFS"},
     {0x7461636f, "OCFS2"},
     {0x01161970, "GFS2"},
     {0x73757245, "Coda"},
     {0x786f4256, "a folder that VirtualBox shares"},
     {0xbacbacbc, "a folder that VMware shares"}}};

constexpr std::string_view suffix_of_growing = "@growing";

// Returns the kind among `kinds` of the file system of the path, or of the nearest existing folder above it.
template <typename Kinds>
std::optional<std::string> kind_among(const Kinds& kinds, const fs::path& path) {
  fs::path existing = fs::absolute(path);
  while (!fs::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
  struct statfs about {};
  if (statfs(existing.c_str(), &about) != 0) {
    throw std::system_error(errno, std::generic_category(), existing.string());
  }
  // The field is signed or unsigned, 32 or 64 bits wide, depending on the machine.
  const unsigned long magic = static_cast<unsigned long>(about.f_type) & 0xffffffffUL;
  for (const auto& [number, name] : kinds) {
    if (number == magic) return name;
  }
  return std::nullopt;
}

struct Guarded {
  fs::path folder;
  std::set<std::string> own_folders;  // subfolders that belong in it
};

// A folder of backups may hold copies of checkpoints, spool and files.
std::vector<Guarded> guarded_folders(const CampaignDirectory& directory) {
  return {
      {directory.spool(), {directory.rejected().filename().string(), directory.left().filename().string()}},
      {directory.rejected(), {}},
      {directory.left(), {}},
      {directory.checkpoints(), {}},
      {directory.failures(), {}},
      {directory.logs(), {}},
      {directory.requests(), {}},
      {directory.backup(),
       {directory.spool().filename().string(), directory.checkpoints().filename().string(),
        directory.files().filename().string()}}};
}

std::vector<fs::path> intruders_in(const Guarded& guarded) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(guarded.folder)) {
    const fs::file_type type = entry.symlink_status().type();
    const bool belongs =
        type == fs::file_type::regular ||
        (type == fs::file_type::directory && guarded.own_folders.contains(entry.path().filename().string()));
    if (!belongs) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string listed(const std::vector<fs::path>& found) {
  constexpr std::size_t most = 2;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i) {
    text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", plain_name(found[i]), kind_of(found[i]));
  }
  return found.size() > most ? fmt::format("{} and {} more", text, found.size() - most) : text;
}

// Returns the source of the build tree whose bin/ has this program, from CMakeCache.txt.
std::optional<fs::path> source_of_build() {
  constexpr std::string_view entry = "CMAKE_HOME_DIRECTORY:INTERNAL=";
  std::ifstream cache(own_folder().parent_path() / "CMakeCache.txt");
  for (std::string line; std::getline(cache, line);) {
    if (line.starts_with(entry)) return line.substr(entry.size());
  }
  return std::nullopt;
}

}  // namespace

fs::path CampaignDirectory::checkpoint(const std::string& hash, int seed) const {
  return checkpoints() / (stem(hash, seed) + ".checkpoint");
}

fs::path growing_beside(const fs::path& checkpoint) {
  fs::path file = checkpoint;
  return file += suffix_of_growing;
}

bool is_growing(const fs::path& file) { return file.string().ends_with(suffix_of_growing); }

fs::path checkpoint_of(const fs::path& file) {
  const std::string name = file.string();
  return is_growing(file) ? name.substr(0, name.size() - suffix_of_growing.size()) : name;
}

fs::path CampaignDirectory::spool_file(const std::string& hash, int seed, std::int64_t attempt) const {
  return spool() / fmt::format("{}-{}.json", stem(hash, seed), attempt);
}

// The view `files` spells the same path.
fs::path CampaignDirectory::left_files(const std::string& hash, std::int64_t point_id, int seed) const {
  return files() / fmt::format("{}-{}", hash.substr(0, 16), point_id) / fmt::format("{:06}", seed);
}

fs::path CampaignDirectory::worker_log(int worker) const {
  return logs() / fmt::format("worker-{}.log", worker);
}

CampaignDirectory campaign_directory(const fs::path& campaign_file, const fs::path& chosen) {
  if (!chosen.empty()) return CampaignDirectory(fs::absolute(chosen).lexically_normal());
  fs::path folder = fs::absolute(campaign_file).lexically_normal();
  folder.replace_extension(".peclet");
  return CampaignDirectory(folder);
}

std::vector<fs::path> folders_below(const CampaignDirectory& directory) {
  return {directory.spool(),    directory.rejected(), directory.left(),   directory.checkpoints(),
          directory.failures(), directory.logs(),     directory.backup(), directory.requests()};
}

void create_folders(const CampaignDirectory& directory) {
  fs::create_directories(directory.root());
  for (const fs::path& folder : folders_below(directory)) fs::create_directories(folder);
}

void require_own_folders(const CampaignDirectory& directory) {
  require_own_folder(directory.root(), true);
  for (const fs::path& folder : folders_below(directory)) require_own_folder(folder);
  require_own_folder(directory.files());
  require_own_folder(directory.aside());
}

ScratchFolder::ScratchFolder(const std::string& name) {
  std::string path = (fs::temp_directory_path() / (name + "-XXXXXX")).string();
  if (mkdtemp(path.data()) == nullptr) throw std::system_error(errno, std::generic_category(), path);
  path_ = path;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // remnants stay among temporary files
  fs::remove_all(path_, ignored);
}

fs::path make_folder_aside(const CampaignDirectory& directory) {
  require_own_folder(directory.aside());
  fs::create_directories(directory.aside());
  for (int number = 1;; ++number) {
    const fs::path folder = directory.aside() / std::to_string(number);
    if (kind_of(folder).empty() && fs::create_directory(folder)) return folder;
  }
}

std::optional<std::string> network_file_system(const fs::path& path) {
  return kind_among(network_kinds, path);
}

std::string doubt_about_file_system(const fs::path& path) {
  const std::optional<std::string> kind = kind_among(doubtful_kinds, path);
  if (!kind) return "";
  return fmt::format(
      "{}: is on {}; if that is one of a network, its locks and fsync cannot be trusted: use it from one "
      "machine alone, or choose a --directory on a local disk",
      path.string(), *kind);
}

void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell) {
  for (const Guarded& guarded : guarded_folders(directory)) {
    if (kind_of(guarded.folder).empty()) continue;
    const std::vector<fs::path> found = intruders_in(guarded);
    if (found.empty()) continue;
    const std::string names = listed(found);
    const fs::path aside = make_folder_aside(directory);
    for (const fs::path& path : found) fs::rename(path, aside / path.filename());
    tell(fmt::format("{}/ had entries that are not regular files: {}; moved to {}/{}/",
                     guarded.folder.lexically_relative(directory.root()).string(), names,
                     directory.aside().filename().string(), aside.filename().string()));
  }
}

std::string make_way(const fs::path& path, const std::string& wanted) {
  const std::string kind = kind_of(path);
  if (kind.empty() || kind == wanted) return "";
  const fs::path aside = free_name(path.string() + "@aside");
  fs::rename(path, aside);
  return fmt::format("{}: was {} in the place of {}; moved to {}", path.string(), kind, wanted,
                     plain_name(aside));
}

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
