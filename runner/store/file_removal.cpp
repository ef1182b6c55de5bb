#include "runner/store/file_removal.h"

#include <csignal>
#include <utility>

#include "contract/guarded_file.h"

namespace peclet::runner {

// Blocks all signals in the new thread, so that they reach the thread that waits for them.
FileRemoval::FileRemoval() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { work(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

FileRemoval::~FileRemoval() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FileRemoval::add(const std::vector<fs::path>& files) {
  {
    const std::lock_guard lock(mutex_);
    throw_error();
    files_.insert(files_.end(), files.begin(), files.end());
  }
  changed_.notify_all();
}

void FileRemoval::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return files_.empty() && !busy_; });
  throw_error();
}

void FileRemoval::throw_error() {
  if (const std::error_code error = std::exchange(error_, {})) {
    throw std::system_error(error, "cannot remove " + path_.string());
  }
}

void FileRemoval::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !files_.empty(); });
    if (files_.empty()) return;
    const std::vector<fs::path> files = std::exchange(files_, {});
    busy_ = true;
    lock.unlock();
    std::error_code error;
    fs::path culprit;
    for (const fs::path& file : files) {
      std::error_code own;
      fs::remove(file, own);
      // A folder in a file's place stays; the next start moves it aside.
      if (own && kind_of(file) != "a folder" && !error) {
        error = own;
        culprit = file;
      }
    }
    lock.lock();
    if (error) {
      error_ = error;
      path_ = culprit;
    }
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace peclet::runner
