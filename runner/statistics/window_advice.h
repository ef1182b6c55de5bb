// Judges production windows: whether they begin too early, and whether longer ones are worth their time.
#pragma once

#include <optional>
#include <span>

#include "runner/statistics/quantities.h"

namespace peclet::runner {

// Returns true if the production window begins before the transient of the equilibration is over.
//
// More seeds never remove such a bias. Noise hides the transient of a single realisation; over the seeds of a
// cohort it shows, because its sign is the same in all of them. Each seed has two contrasts of its block
// means of value + control: the first quarter of the window minus the whole (for transients that are short
// against the window), and the first half minus the whole (for long ones). Realisations are independent.
// Without a transient, the mean of a contrast over its standard error is therefore Student's t, whatever the
// correlations within a realisation. A transient much longer than the window escapes this test: its bias may
// be many times its change from one half to the other.
//
// A transient is reported if one of the contrasts would occur by chance once in 1000 stop tests (two tests at
// 0.05 % each). Returns false if fewer than five seeds have contrasts.
bool has_transient(std::span<const Observation> observed);

// The number of seeds with contrasts that a test needs.
constexpr int fewest_contrasts = 5;

// Returns true if no test was possible because results lack blocks of the observable: only `contrasts` of
// `values` realisations with a value have them. More seeds would not help.
constexpr bool lacks_blocks(int values, int contrasts) {
  return contrasts < fewest_contrasts && contrasts < values;
}

// Compares longer production windows with more seeds: which gives the same error in less processor time.
//
// A realisation costs its equilibration E and its window T. Over the realisations, the halves of the window
// have a correlation r, and the variance of the whole is (1 + r) / 2 times that of a half. For equal errors
//   a window of T/2 costs (E + T/2) / (E + T) * 2 / (1 + r),
//   a window of 2T costs (E + 2T) / (E + T) * (1 + r') / 2
// times the present one. The correlation r' of two consecutive windows lies between 0 and max(r, 0).
struct WindowHalves {
  double first = 0, second = 0;
};

struct WindowAdvice {
  double correlation = 0;    // r
  double low = 0, high = 0;  // its 95 % interval, by Fisher's z
  double half_as_long = 0;   // factors of processor time for the same error
  double twice_as_long_at_best = 0, twice_as_long_at_worst = 0;
};

// Returns the advice for an equilibration and a production of these costs, in any unit. Returns nothing for
// fewer than eight realisations, if a half has no spread, and if |r| is 1.
std::optional<WindowAdvice> advise_window(std::span<const WindowHalves> halves, double equilibration,
                                          double production);

}  // namespace peclet::runner
