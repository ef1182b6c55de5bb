// Production windows: whether one begins too early, and whether a longer one is worth its time.
#pragma once

#include <optional>
#include <span>

#include "runner/statistics/quantities.h"

namespace peclet::runner {

// Whether the production window begins before the transient of the equilibration is over.
//
// More seeds never remove such a bias. Within one realisation a transient drowns in the noise; over the seeds
// of a cohort it does not, because its sign is the same in all of them. Per seed, two contrasts of the series
// of block means of value + control: the first quarter of the window minus the whole (for transients that are
// short beside the window) and the first half minus the whole (for long ones). Realisations are independent,
// so the mean of a contrast over the seeds, divided by its standard error, is Student's t where there is no
// transient, whatever the correlations inside a realisation. What no window can tell is a transient
// much longer than itself: its bias may be many times what it changes from one half to the other.
//
// True when one of the two contrasts is beyond what happens by chance once in 1000 stop tests without a
// transient (two tests at 0.05 % each). False for fewer than five seeds whose contrasts are known.
bool has_transient(std::span<const Observation> observed);

// Seeds whose contrasts must be known for a test.
constexpr int fewest_contrasts = 5;

// Whether there was no test because results have no blocks of the observable: of `values` realisations with a
// value so few have `contrasts`. More seeds would not help.
constexpr bool lacks_blocks(int values, int contrasts) {
  return contrasts < fewest_contrasts && contrasts < values;
}

// Longer production windows or more seeds: which gives the same error for less processor time.
//
// A realisation costs its equilibration E and its window T. The halves of the windows of n realisations tell
// how fast its worth grows with T: with r the correlation of the two halves over the realisations, the
// variance of the whole is (1 + r) / 2 times that of a half. So, for equal errors,
//   a window of T/2 costs (E + T/2) / (E + T) * 2 / (1 + r),
//   a window of 2T costs (E + 2T) / (E + T) * (1 + r') / 2
// times as much, r' being the correlation of two windows in a row, which lies between 0 and max(r, 0).
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
