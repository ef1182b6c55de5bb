// Opens files in folders that another user may have prepared. Links are not followed, FIFOs not waited for,
// and files that are too large not read.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "contract/durable_file.h"
#include "contract/errors.h"

namespace peclet {

// A path leads to something else than the file or folder that is allowed there; it was not read or changed.
class UnsuitableFile : public InputError {
 public:
  using InputError::InputError;
};

// Returns "a link", "a folder", "a FIFO", "a socket", "a device" or "a regular file"; "" if nothing is there.
// Does not follow a link.
std::string kind_of(const std::filesystem::path& path);

// Throws UnsuitableFile if the path exists and is not a regular file.
void require_regular(const std::filesystem::path& path);

// Opens a regular file with the flags of open(2), which may create it. Throws UnsuitableFile if the path is
// anything else, without opening it or waiting for it. Throws std::system_error naming the path.
Descriptor open_regular(const std::filesystem::path& path, int flags, unsigned mode = 0666);

// Returns the content of a regular file of at most `most` bytes. Throws UnsuitableFile, std::system_error.
std::string read_regular(const std::filesystem::path& path, std::uint64_t most);

// Replaces `to`, durably, by a copy of a regular file of at most `most` bytes. Throws as read_regular().
void copy_regular(const std::filesystem::path& from, const std::filesystem::path& to, std::uint64_t most);

// Throws UnsuitableFile if the path exists and is not a folder, is a link (unless `may_be_link`), or belongs
// to another user than `self` or root, who could replace what is in it.
void require_own_folder(const std::filesystem::path& path, bool may_be_link = false, uid_t self = geteuid());

// Returns the name of a user in /etc/passwd, or the user's number if there is no name.
std::string user_name(uid_t user);

}  // namespace peclet
