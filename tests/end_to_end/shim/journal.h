// What a power cut would take back: every change of a file that has not been followed by fsync.
//
// Records go to one file per process in the folder PECLET_FAULT_JOURNAL: a line
//     SEQUENCE KIND INODE OFFSET OLD_SIZE BYTES PATH [-> PATH]
// and so many bytes of what was there before. A change is recorded before it is made, a synchronisation after
// it. Files that are removed or replaced live on under a second name in `kept/SEQUENCE`.
#pragma once

#include <sys/types.h>

#include <string>

namespace peclet::drill {

void note_created(const std::string& path);
// `count` bytes at `offset` are about to be written.
void note_write(int descriptor, off_t offset, std::size_t count);
void note_truncation(int descriptor, off_t size);
void note_synchronised(int descriptor);
void note_rename(const std::string& from, const std::string& to);
void note_removal(const std::string& path);

}  // namespace peclet::drill
