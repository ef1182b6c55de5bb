#include "engine/threads/waiting_threads.h"

#include <unistd.h>

#include <cstdlib>

namespace peclet::engine {
namespace {

// What libgomp itself gives to threads beyond the number of processors: some microseconds.
constexpr const char* turns = "1000";

}  // namespace

void let_waiting_threads_sleep(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  // Set, it also tells the program that starts now to go on.
  if (setenv("GOMP_SPINCOUNT", turns, 0) == 0) execv("/proc/self/exe", arguments);
}

}  // namespace peclet::engine
