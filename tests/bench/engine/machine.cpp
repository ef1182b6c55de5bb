#include "tests/bench/engine/machine.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "tests/bench/engine/peak_loops.h"

namespace peclet::engine {
namespace {

constexpr int repetitions = 7;
constexpr std::size_t beyond_caches = std::size_t{192} << 20;

// Returns the shortest duration of `work` [s].
template <class Work>
double fastest(Work&& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repetitions; ++r) {
    const auto start = std::chrono::steady_clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

const PeakLoops& loops_of([[maybe_unused]] InstructionSet set) {
#ifdef PECLET_NEWER_SETS
  if (set == InstructionSet::avx2) return avx2_peak_loops;
  if (set == InstructionSet::avx512) return avx512_peak_loops;
#endif
  return baseline_peak_loops;
}

double rate(PeakLoops::Loop loop, std::uint64_t per_round) {
  constexpr std::uint64_t rounds = 400000;
  volatile double keep = 0;
  return static_cast<double>(rounds * per_round) / fastest([&] { keep = loop(rounds); });
}

struct alignas(64) CacheLine {
  double number[8];
};

}  // namespace

double stream_rate(InstructionSet set, std::size_t room) {
  const std::size_t lines = std::max<std::size_t>(1, room / (3 * sizeof(CacheLine))), count = 8 * lines;
  std::vector<CacheLine> a(lines), b(lines, {{1, 1, 1, 1, 1, 1, 1, 1}}), c(b);
  constexpr std::size_t streamed = std::size_t{1} << 26;  // bytes per measurement; at least one pass
  const std::size_t passes = std::max<std::size_t>(1, streamed / room);
  const auto stream = loops_of(set).stream;
  volatile double factor = 3;
  const double seconds = fastest([&] {
    for (std::size_t pass = 0; pass < passes; ++pass) {
      stream(a.data()->number, b.data()->number, c.data()->number, factor, count);
    }
  });
  factor = a[lines / 2].number[0];
  return 4.0 * sizeof(double) * static_cast<double>(count * passes) / seconds;
}

Machine measure_machine(InstructionSet set) {
  const PeakLoops& loops = loops_of(set);
  return {.products_and_sums = 2 * rate(loops.multiply_add, loops.per_round),
          .quotients = rate(loops.divide, loops.per_round),
          .roots = rate(loops.square_root, loops.per_round),
          .bytes = stream_rate(set, beyond_caches),
          .single_products_and_sums = 2 * rate(loops.multiply_add_single, loops.singles_per_round)};
}

}  // namespace peclet::engine
