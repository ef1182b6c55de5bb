// A log file of bounded size: NAME is written, NAME.1 is older, NAME.2 older still.
#pragma once

#include <cstdint>
#include <string_view>

#include "runner/campaign/paths.h"

namespace peclet::runner {

// Not thread-safe. Logs are never worth a campaign: what cannot be written, because the disk is full or
// something else than a regular file bears the name, is
// dropped and counted, and the next line that can be written is preceded by how much was lost.
class RotatingFile {
 public:
  // Each file has at most `limit` bytes; `older` of them are kept beside the one that is written.
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
