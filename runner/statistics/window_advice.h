// Longer production windows or more seeds: which gives the same error for less processor time.
//
// A realisation costs its equilibration E and its window T. The halves of the windows of n realisations tell
// how fast its worth grows with T: with r the correlation of the two halves over the realisations, the
// variance of the whole is (1 + r) / 2 times that of a half. So, for equal errors,
//   a window of T/2 costs (E + T/2) / (E + T) * 2 / (1 + r),
//   a window of 2T costs (E + 2T) / (E + T) * (1 + r') / 2
// times as much, r' being the correlation of two windows in a row, which lies between 0 and max(r, 0).
#pragma once

#include <optional>
#include <span>

namespace peclet::runner {

struct WindowHalves {
  double first = 0, second = 0;
};

struct WindowAdvice {
  double correlation = 0;    // r
  double low = 0, high = 0;  // its 95 % interval, by Fisher's z
  double half_as_long = 0;   // factors of processor time for the same error
  double twice_as_long_at_best = 0, twice_as_long_at_worst = 0;
};

// `equilibration` and `production` in any unit of cost. Nothing for fewer than eight realisations, or where
// one of the halves has no spread.
std::optional<WindowAdvice> advise_window(std::span<const WindowHalves> halves, double equilibration,
                                          double production);

}  // namespace peclet::runner
