// Removes files in the background.
//
// While many workers make files durable, the file system lets every removal wait for its journal, about a
// millisecond each: more than the booking of the result whose spool file it is. A file whose removal was
// forgotten because the process died is removed by the next one, which finds it again.
#pragma once

#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "runner/campaign/paths.h"

namespace peclet::runner {

class FileRemoval {
 public:
  FileRemoval();
  // Returns when all removals have been tried. Files that could not be removed stay, without a message.
  ~FileRemoval();
  FileRemoval& operator=(FileRemoval&&) = delete;

  // Removes the files soon, in this order; one that is not there is no matter. Throws std::system_error for
  // an earlier one that could not be removed.
  void add(const std::vector<fs::path>& files);
  // Returns when none is left. Throws as add().
  void finish();

 private:
  void work();
  void throw_error();

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::vector<fs::path> files_;
  bool busy_ = false, ends_ = false;
  fs::path path_;  // that could not be removed, and why
  std::error_code error_;
  std::thread thread_;
};

}  // namespace peclet::runner
