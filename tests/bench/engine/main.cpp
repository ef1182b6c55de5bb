// engine_bench [CASE...]: prints processor time per particle and step of the named cases, or of all.
#include <fmt/format.h>

#include <exception>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "engine/state/threads.h"
#include "tests/bench/engine/benchmark.h"

int main(int argc, char** argv) {
  peclet::engine::let_waiting_threads_sleep(argv);
  try {
    peclet::engine::run_benchmarks(std::vector<std::string>(argv + 1, argv + argc));
    return peclet::ExitCode::done;
  } catch (const peclet::InputError& error) {
    fmt::print(stderr, "engine_bench: {}\n", error.what());
    return peclet::ExitCode::usage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "engine_bench: {}\n", error.what());
    return peclet::ExitCode::error;
  }
}
