// Files that a person names: read whole and not without bound, written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
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

// Throws InputError when nothing can be written under the name: a folder, a socket, a loop of links, a
// descriptor that is not open, no folder to make a file in, no permission. For programs that work for long
// before they have something to write.
void check_output(const std::filesystem::path& path);

// Writes `bytes` where the name leads. A regular file, also one that is not there yet, is replaced as by
// write_durably(); a link is followed and stays. A device or a FIFO is opened and written to, never replaced,
// and so is what /dev/stdout, /dev/fd/N or a shell's >(...) stand for.
// Throws as check_output(), NoRoomError, std::system_error naming the path.
void write_output(const std::filesystem::path& path, std::string_view bytes);

// The same of texts that `next` hands out one after the other, up to an empty one, which together need not
// fit into memory. What `next` throws leaves a regular file as it was.
void write_output(const std::filesystem::path& path, const std::function<std::string()>& next);

}  // namespace peclet
