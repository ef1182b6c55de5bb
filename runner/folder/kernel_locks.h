// Who holds a lock on a file, by the kernel's list of locks.
#pragma once

#include <cstdint>
#include <string>

namespace peclet::runner {

// Returns the process that holds a write lock of this kind ("FLOCK", "POSIX") on the file with this inode, on
// the byte `at`; 0 if the list names none. Nothing is opened: closing a file takes a process's own locks
// away.
std::int64_t process_that_locks(std::uint64_t inode, const std::string& kind, std::uint64_t at = 0);

}  // namespace peclet::runner
