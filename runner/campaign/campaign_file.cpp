#include "runner/campaign/campaign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "contract/input_error.h"
#include "contract/nearest_name.h"
#include "runner/text/quoting.h"

namespace peclet::runner {

namespace fs = std::filesystem;

namespace {

// A name that cannot be followed, because it is a loop or too long, is no folder; whoever reads it says why.
bool is_folder(const fs::path& given) {
  std::error_code impossible;
  return fs::is_directory(given, impossible);
}

}  // namespace

fs::path campaign_file_of(const fs::path& given) {
  if (!is_folder(given)) return given;
  fs::path file = given.has_filename() ? given : given.parent_path();  // a slash at the end
  return file.replace_extension(".json");
}

std::string words_for(const fs::path& campaign_file, const fs::path& chosen) {
  const std::string words = shell_word(campaign_file.string());
  return chosen.empty() ? words : fmt::format("{} --directory {}", words, shell_word(chosen.string()));
}

std::string similar_name(const fs::path& given) {
  const fs::path folder = given.has_parent_path() ? given.parent_path() : ".";
  std::error_code unreadable;  // then there is nothing to offer
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, unreadable)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".json" || extension == ".peclet") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  const std::string nearest = nearest_name(given.filename().string(), names);
  if (nearest.empty()) return "";
  return fmt::format("; did you mean {}?", (given.parent_path() / nearest).string());
}

void require_campaign_file(const fs::path& given) {
  if (is_folder(given)) {
    const fs::path file = campaign_file_of(given);
    throw InputError(given.string(), "", "",
                     fs::is_regular_file(file)
                         ? fmt::format("is a folder, and the campaign's file is asked for: {}", file.string())
                         : "is a folder, and a campaign's file is asked for");
  }
  std::error_code impossible;
  if (!fs::exists(given, impossible) && !impossible) {
    throw InputError(given.string(), "", "", "no such file" + similar_name(given));
  }
}

fs::path home_of(const fs::path& campaign_file) {
  std::error_code impossible;
  return fs::is_regular_file(campaign_file, impossible) ? fs::absolute(campaign_file).parent_path()
                                                        : fs::current_path();
}

}  // namespace peclet::runner
