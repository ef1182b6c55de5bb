// http_fuzz [--seconds 600] [--seed 1]: the long form of the fuzzer of the live server. Build it with
// sanitizers (preset asan-ubsan). Prints what an answer was not, and leaves with 1 if there was something.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <string>

#include "tests/fuzz/http_fuzzing.h"

int main(int argc, char** argv) {
  std::map<std::string, unsigned long> options{{"--seconds", 600}, {"--seed", 1}};
  for (int i = 1; i < argc; i += 2) {
    if (!options.contains(argv[i]) || i + 1 == argc) {
      fmt::print(stderr, "http_fuzz: {}: use --seconds N and --seed N\n", argv[i]);
      return 2;
    }
    options[argv[i]] = std::strtoul(argv[i + 1], nullptr, 10);
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(options["--seconds"]);
  const peclet::runner::FuzzReport report = peclet::runner::fuzz_live_server(
      options["--seed"], [&](const auto&) { return std::chrono::steady_clock::now() < end; });
  for (const std::string& finding : report.findings) fmt::print("{}\n", finding);
  fmt::print("{} requests, {} different answers, {} findings\n", report.requests, report.answers,
             report.findings.size());
  return report.findings.empty() ? 0 : 1;
}
