#include "runner/care/periodic_backup.h"

#include <fmt/format.h>

#include <exception>
#include <stdexcept>
#include <utility>

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// A backup must not be what fills the disk: beside it, there has to be room for as much again.
void refuse_to_fill_the_disk(const CampaignDirectory& directory) {
  const std::uintmax_t size = fs::file_size(directory.database());
  const std::uintmax_t available = fs::space(directory.backup()).available;
  if (available >= 2 * size) return;
  throw std::runtime_error(fmt::format(
      "{}: {:.1f} MB are free, and a backup needs twice the {:.1f} MB of the database",
      directory.backup().string(), 1e-6 * static_cast<double>(available), 1e-6 * static_cast<double>(size)));
}

Backup back_up(const CampaignDirectory& directory) {
  fs::create_directories(directory.backup());
  refuse_to_fill_the_disk(directory);
  return make_backup(directory, directory.backup(), false);
}

}  // namespace

PeriodicBackup::PeriodicBackup(CampaignDirectory directory, std::chrono::duration<double> interval,
                               RunListener& listener, Time now)
    : directory_(std::move(directory)), interval_(interval), listener_(listener), last_(now) {}

PeriodicBackup::~PeriodicBackup() {
  if (running_.valid()) running_.wait();
}

void PeriodicBackup::attend(Time now) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    tell();
    last_ = now;
  }
  if (now - last_ >= interval_) start();
}

void PeriodicBackup::finish() {
  if (running_.valid()) tell();
  start();
  tell();
}

void PeriodicBackup::start() {
  running_ = std::async(std::launch::async, [directory = directory_] { return back_up(directory); });
}

void PeriodicBackup::tell() {
  try {
    running_.get();
    complaint_.clear();
  } catch (const std::exception& error) {
    if (complaint_ == error.what()) return;
    complaint_ = error.what();
    listener_.warn("no backup could be made, which is tried again: " + complaint_);
  }
}

}  // namespace peclet::runner
