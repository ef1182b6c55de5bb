// Files that a person gives us: read once and whole, and not without bound.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "contract/json.h"

namespace peclet {

// How much an input may be. A file that is larger is refused before it is read, a pipe or a device once it
// has given more.
struct InputLimits {
  std::size_t bytes;
  std::size_t values;  // numbers, texts, arrays ... of a JSON document, which take more memory than its text
};

// Of scenes and campaigns. 100 000 points, the most that there may be, with five pointers set in step are
// 600 000 values and about 10 MB.
constexpr InputLimits input_limits{std::size_t{16} << 20, 1'000'000};

// The whole content of anything that can be read, a pipe as well.
// Throws InputError when it is absent, unreadable or too large.
std::string read_input(const std::filesystem::path& path, const InputLimits& limits = input_limits);

// As parse_json(), and with no more than `most_values` values.
Json parse_json_input(std::string_view text, const std::string& file,
                      std::size_t most_values = input_limits.values);

// Both. Throws InputError.
Json read_json_input(const std::filesystem::path& path, const InputLimits& limits = input_limits);

}  // namespace peclet
