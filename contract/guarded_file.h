// Files in folders that somebody else may have prepared. A link in the place of a file leads to another one,
// a FIFO waits for ever, a sparse file takes all memory: none of them is followed, waited for or read.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "contract/durable_file.h"
#include "contract/errors.h"

namespace peclet {

// What bears the name is not what may be there, and was neither read nor changed.
class UnsuitableFile : public InputError {
 public:
  using InputError::InputError;
};

// "a link", "a folder", "a FIFO", "a socket", "a device", "a regular file"; "" when nothing is there. A link
// is not followed.
std::string kind_of(const std::filesystem::path& path);

// Throws UnsuitableFile when something is there that is no regular file.
void require_regular(const std::filesystem::path& path);

// Opens a regular file with the flags of open(2), which may create it. Throws UnsuitableFile when something
// else bears the name, without having opened it or waited for it; std::system_error naming the path.
Descriptor open_regular(const std::filesystem::path& path, int flags, unsigned mode = 0666);

// The whole content of a regular file of at most `most` bytes. Throws UnsuitableFile, std::system_error.
std::string read_regular(const std::filesystem::path& path, std::uint64_t most);

// Replaces `to`, durably, by a copy of a regular file of at most `most` bytes. Throws as read_regular().
void copy_regular(const std::filesystem::path& from, const std::filesystem::path& to, std::uint64_t most);

// A folder into which others may put what they like is not one to work in. Throws UnsuitableFile when
// something is there that is no folder, is a link (unless `may_be_link`), or belongs to another user than
// `self` or root.
void require_own_folder(const std::filesystem::path& path, bool may_be_link = false, uid_t self = geteuid());

// As people know the user, or the number of one without a name.
std::string user_name(uid_t user);

}  // namespace peclet
