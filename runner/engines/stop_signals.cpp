#include "runner/engines/stop_signals.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace peclet::runner {

namespace {

// Whoever started this with nohup wants it to outlive the terminal. (A signal that is blocked is kept even if
// it is to be ignored.)
bool is_ignored(int number) {
  struct sigaction present {};
  return sigaction(number, nullptr, &present) == 0 && present.sa_handler == SIG_IGN;
}

}  // namespace

StopSignals::StopSignals(int one_more) {
  sigemptyset(&stopping_);
  for (const int number : {SIGINT, SIGTERM, one_more}) sigaddset(&stopping_, number);
  if (!is_ignored(SIGHUP)) sigaddset(&stopping_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &stopping_, nullptr);
  descriptor_ = signalfd(-1, &stopping_, SFD_NONBLOCK | SFD_CLOEXEC);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

// A signal that came too late for anybody to take must not kill a process that is leaving anyway.
StopSignals::~StopSignals() {
  while (take()) {
  }
  close(descriptor_);
  pthread_sigmask(SIG_UNBLOCK, &stopping_, nullptr);
}

bool StopSignals::take() {
  signalfd_siginfo about{};
  return read(descriptor_, &about, sizeof(about)) == static_cast<ssize_t>(sizeof(about));
}

bool StopSignals::wait(std::chrono::milliseconds patience) {
  pollfd watched{descriptor_, POLLIN, 0};
  return poll(&watched, 1, static_cast<int>(patience.count())) > 0 && take();
}

}  // namespace peclet::runner
