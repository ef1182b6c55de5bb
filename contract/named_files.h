// Reads and writes files that a user names: reads with a bound on the size, writes whole files or nothing.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "contract/json.h"

namespace peclet {

// Bounds on an input. A larger file is refused before it is read, a pipe or a device once it exceeds them.
struct InputLimits {
  std::size_t bytes;
  std::size_t values;  // numbers, texts, arrays ... of a JSON document, which take more memory than its text
};

// Limits of scenes and campaigns: 100000 points, the most allowed, with five pointers set in step take 600000
// values and about 10 MB.
constexpr InputLimits input_limits{std::size_t{16} << 20, 1'000'000};

// Returns the content of a file, pipe or device. Throws InputError if it is absent, unreadable or too large.
std::string read_input(const std::filesystem::path& path, const InputLimits& limits = input_limits);

// Parses JSON as parse_json(), with comments as in without_comments(), which people write. Throws InputError
// also for more than `most_values` values.
Json parse_json_input(std::string_view text, const std::string& file,
                      std::size_t most_values = input_limits.values);

// Reads with read_input() and parses with parse_json_input(). Throws InputError.
Json read_json_input(const std::filesystem::path& path, const InputLimits& limits = input_limits);

// Throws InputError if nothing can be written under the name: a folder, a socket, a loop of links, a
// descriptor that is not open, a missing folder, no permission. For programs that write only at their end.
void check_output(const std::filesystem::path& path);

// Writes `bytes` to the file with this name. Links are followed and stay. A regular or absent file is
// replaced with write_durably(). A device, a FIFO and what /dev/stdout, /dev/fd/N or a shell's >(...) stand
// for are written to, never replaced. Throws as check_output(), NoRoomError, std::system_error.
void write_output(const std::filesystem::path& path, std::string_view bytes);

// Writes the texts that next() returns up to an empty one. They need not fit into memory together. If next()
// throws, a regular file stays as it was. Throws as above.
void write_output(const std::filesystem::path& path, const std::function<std::string()>& next);

}  // namespace peclet
