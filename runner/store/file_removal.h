// FileRemoval removes files in the background.
//
// While many workers make files durable, each removal waits for the file system's journal for about a
// millisecond. This is longer than booking the result takes. If the process dies, the next run finds the
// remaining files and removes them.
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

  // Removes the files soon, in this order; absent files are ignored. Throws std::system_error for an earlier
  // file that could not be removed.
  void add(const std::vector<fs::path>& files);
  // Returns when all removals have been tried. Throws as add().
  void finish();

 private:
  void work();
  void throw_error();

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::vector<fs::path> files_;
  bool busy_ = false, ends_ = false;
  fs::path path_;  // file that could not be removed, and the error
  std::error_code error_;
  std::thread thread_;
};

}  // namespace peclet::runner
