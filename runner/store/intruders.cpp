#include "runner/store/intruders.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

struct Guarded {
  fs::path folder;
  std::set<std::string> own_folders;  // that belong in it
};

// As restore() leaves them, a folder of backups may hold checkpoints and a spool.
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

}  // namespace

void move_intruders_aside(const CampaignDirectory& directory,
                          const std::function<void(const std::string&)>& tell) {
  for (const Guarded& guarded : guarded_folders(directory)) {
    if (kind_of(guarded.folder).empty()) continue;
    const std::vector<fs::path> found = intruders_in(guarded);
    if (found.empty()) continue;
    const std::string names = listed(found);
    const fs::path aside = make_folder_aside(directory);
    for (const fs::path& path : found) fs::rename(path, aside / path.filename());
    tell(fmt::format("{}/ had what is no file: {}; moved to {}/{}/",
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

}  // namespace peclet::runner
