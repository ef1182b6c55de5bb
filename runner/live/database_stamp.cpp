#include "runner/live/database_stamp.h"

#include <sys/stat.h>

#include <string>

#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

// By its name alone: whoever opens a database beside SQLite takes its locks away when he closes it.
DatabaseStamp::File file_stamp(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) return {};
  return {about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
}

bool was_written_after(const DatabaseStamp::File& file, std::chrono::system_clock::time_point time) {
  const auto written = std::chrono::seconds(file.seconds) + std::chrono::nanoseconds(file.nanoseconds);
  return file.number != 0 && written > time.time_since_epoch();
}

}  // namespace

bool DatabaseStamp::is_fresh(std::chrono::system_clock::time_point now) const {
  const auto just_now = now - std::chrono::milliseconds(100);
  return was_written_after(database, just_now) || was_written_after(log, just_now);
}

DatabaseStamp stamp_of(const CampaignDirectory& directory) {
  const std::string database = directory.database().string();
  return {file_stamp(database), file_stamp(database + "-wal"), current_owner(directory)};
}

}  // namespace peclet::runner
