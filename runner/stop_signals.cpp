#include "runner/stop_signals.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace peclet::runner {

StopSignals::StopSignals(int one_more) {
  sigemptyset(&stopping_);
  for (const int number : {SIGINT, SIGTERM, one_more}) sigaddset(&stopping_, number);
  pthread_sigmask(SIG_BLOCK, &stopping_, nullptr);
  descriptor_ = signalfd(-1, &stopping_, SFD_NONBLOCK | SFD_CLOEXEC);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

StopSignals::~StopSignals() {
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
