#include "runner/launch/launched_worker.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "runner/launch/far_end.h"
#include "runner/launch/near_end.h"

namespace peclet::runner {

int run_worker(const WorkerOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return options.through.empty() ? FarEnd().run() : NearEnd(options).run();
  } catch (const std::exception& error) {
    std::fputs(fmt::format("peclet worker: {}\n", error.what()).c_str(), stderr);
    return 1;
  }
}

}  // namespace peclet::runner
