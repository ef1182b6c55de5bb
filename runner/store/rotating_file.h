// RotatingFile is a log file of bounded size: NAME is written, NAME.1 is older, NAME.2 older still.
#pragma once

#include <cstdint>
#include <string_view>

#include "runner/campaign/paths.h"

namespace peclet::runner {

// Not thread-safe. A log never stops a campaign: bytes that cannot be written, because the disk is full or
// the name is not a regular file's, are dropped and counted. The next line that can be written is preceded by
// their number.
class RotatingFile {
 public:
  // Each file has at most `limit` bytes; `older` files are kept beside the one that is written.
  RotatingFile(fs::path path, std::uint64_t limit, int older);
  ~RotatingFile();
  RotatingFile& operator=(RotatingFile&&) = delete;

  // Appends the bytes; a piece is not divided between two files unless it is longer than one.
  void append(std::string_view bytes);

 private:
  bool open();
  void reopen(int flags);
  void rotate();
  void write(std::string_view bytes);

  fs::path path_;
  std::uint64_t limit_;
  int older_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0, dropped_ = 0;
};

}  // namespace peclet::runner
