#include "engine/benchmark/machine.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "engine/benchmark/peak_loops.h"

namespace peclet::engine {
namespace {

constexpr int repetitions = 7;

// Fewest seconds that `work` took.
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
#ifdef __x86_64__
  if (set == InstructionSet::avx2) {
    return avx2_peak_loops;
  }
  if (set == InstructionSet::avx512) {
    return avx512_peak_loops;
  }
#endif
  return baseline_peak_loops;
}

double rate(PeakLoops::Loop loop, std::uint64_t per_round) {
  constexpr std::uint64_t rounds = 400000;
  volatile double keep = 0;
  return static_cast<double>(rounds * per_round) / fastest([&] { keep = loop(rounds); });
}

double stream_rate() {
  constexpr std::size_t count = std::size_t{1} << 23;
  std::vector<double> a(count), b(count, 1.0), c(count, 2.0);
  volatile double factor = 3;
  const double seconds = fastest([&] {
    const double s = factor;
    for (std::size_t i = 0; i < count; ++i) {
      a[i] = b[i] + s * c[i];
    }
  });
  factor = a[count / 2];
  return 4.0 * sizeof(double) * static_cast<double>(count) / seconds;
}

}  // namespace

Machine measure_machine(InstructionSet set) {
  const PeakLoops& loops = loops_of(set);
  return {.products_and_sums = 2 * rate(loops.multiply_add, loops.per_round),
          .quotients = rate(loops.divide, loops.per_round),
          .roots = rate(loops.square_root, loops.per_round),
          .bytes = stream_rate()};
}

}  // namespace peclet::engine
