// Whether the production window begins before the transient of the equilibration is over.
//
// More seeds never remove such a bias. Within one realisation a transient drowns in the noise; over the seeds
// of a cohort it does not, because its sign is the same in all of them. Per seed, two contrasts of the series
// of block means of value + control: the first quarter of the window minus the whole (for transients that are
// short beside the window) and the first half minus the whole (for long ones). Realisations are independent,
// so the mean of a contrast over the seeds, divided by its standard error, is Student's t where there is no
// transient, whatever the correlations inside a realisation. What no window can tell is a transient
// much longer than itself: its bias may be many times what it changes from one half to the other.
#pragma once

#include <span>

#include "runner/statistics/observation.h"

namespace peclet::runner {

// True when one of the two contrasts is beyond what happens by chance once in 1000 looks without a transient
// (two tests at 0.05 % each). False for fewer than five seeds whose contrasts are known.
bool has_transient(std::span<const Observation> observed);

// Seeds whose contrasts must be known for a test.
constexpr int fewest_contrasts = 5;

// Whether there was no test because results have no blocks of the observable: of `values` realisations with a
// value so few have `contrasts`. More seeds would not help.
constexpr bool lacks_blocks(int values, int contrasts) {
  return contrasts < fewest_contrasts && contrasts < values;
}

}  // namespace peclet::runner
