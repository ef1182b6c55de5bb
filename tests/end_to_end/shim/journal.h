// Records what a power cut would take back: every change of a file without a later fsync.
//
// Each process writes a file in the folder PECLET_FAULT_JOURNAL. A record is a line
//     SEQUENCE KIND INODE OFFSET OLD_SIZE BYTES PATH [-> PATH]
// and BYTES bytes of the old content. A change is recorded before it is made, a synchronisation after it.
// Removed or replaced files keep a second name in `kept/SEQUENCE`.
#pragma once

#include <sys/types.h>

#include <string>

namespace peclet::drill {

void note_created(const std::string& path);
// Records that `count` bytes at `offset` are about to be written.
void note_write(int descriptor, off_t offset, std::size_t count);
void note_truncation(int descriptor, off_t size);
void note_synchronised(int descriptor);
void note_rename(const std::string& from, const std::string& to);
void note_removal(const std::string& path);

}  // namespace peclet::drill
