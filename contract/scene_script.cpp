#include "contract/scene_script.h"

#include <fmt/format.h>

#include "contract/errors.h"
#include "contract/key_table.h"
#include "contract/named_files.h"

namespace peclet {
namespace {

bool is_in_utf8(const std::string& text) {
  try {
    Json(text).dump();
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

// Returns the content of a file. Throws InputError that has the reason alone.
std::string content_of(const std::filesystem::path& path) {
  try {
    return read_input(path);
  } catch (const InputError& error) {
    throw InputError("", "", "", path.string() + ' ' + error.allowed());
  }
}

}  // namespace

void add_script(Json& scene, const std::filesystem::path& folder, const std::string& file,
                const std::string& pointer) {
  const Json::json_pointer name("/measure/script"), text("/measure/text");
  const bool names_one = scene.is_object() && scene.contains(name) && scene.at(name).is_string();
  if (!names_one || scene.contains(text)) return;
  const auto path = folder / scene.at(name).get<std::string>();
  try {
    std::string content = content_of(path);
    if (content.size() > longest_script)
      throw InputError("", "", "", fmt::format("must have at most {} bytes", longest_script));
    if (!is_in_utf8(content)) throw InputError("", "", "", "must be text in UTF-8");
    scene[text] = std::move(content);
  } catch (const InputError& error) {
    throw InputError(file, pointer + "/measure/script", shortened(scene.at(name)), error.allowed());
  }
}

}  // namespace peclet
