// Where a person wants an answer to be: a file, or whatever else bears the name that was given.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace peclet {

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
