// Words of strangers (an engine, a file) as they may be shown to people.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "contract/printable.h"

namespace peclet::runner {

constexpr std::size_t longest_plain_text = 240;

// One line that no terminal obeys, of no more than `most` characters: see printable().
inline std::string plain(std::string_view text, std::size_t most = longest_plain_text) {
  return printable(text, most);
}

// The last part of a file's name, as plain(), shorter.
inline std::string plain_name(const std::filesystem::path& path) {
  constexpr std::size_t longest = 80;
  return plain(path.filename().string(), longest);
}

}  // namespace peclet::runner
