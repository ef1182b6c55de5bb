#include "runner/campaign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "contract/input_error.h"
#include "contract/nearest_name.h"

namespace peclet::runner {

namespace fs = std::filesystem;

fs::path campaign_file_of(const fs::path& given) {
  if (!fs::is_directory(given)) return given;
  fs::path file = given.has_filename() ? given : given.parent_path();  // a slash at the end
  return file.replace_extension(".json");
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
  if (fs::is_directory(given)) {
    const fs::path file = campaign_file_of(given);
    throw InputError(given.string(), "", "",
                     fs::is_regular_file(file)
                         ? fmt::format("is a folder, and the campaign's file is asked for: {}", file.string())
                         : "is a folder, and a campaign's file is asked for");
  }
  if (!fs::exists(given)) throw InputError(given.string(), "", "", "no such file" + similar_name(given));
}

}  // namespace peclet::runner
