// Which volume fractions to run next, so that the jamming point is known better.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/jamming/estimate.h"

namespace peclet::runner {

struct ProposedPoint {
  double fraction;     // four decimals
  std::string reason;  // for people
};

// The next fraction of one curve, given what has been proposed of all; none where there is nothing to be
// gained.
//
// Where the law is determined: the one that makes the error of phi_m smallest,
//   var(phi_m) = 1 / sum_i w_i (g_i - its fit by the law's other columns)^2,  g = -beta phi / (phi_m (phi_m -
//   phi)),
// with one more point of the fitted ones' median weight, among fractions up to two errors below phi_m and up
// to half-way from what flows to phi_m: nearer to it a small system may jam. Where it is not: half-way
// between the largest fraction that flows and the smallest one that does not; the widest gap among flowing
// ones where these are near each other; beyond the last one, or before the first, where all flow or none
// does.
std::optional<ProposedPoint> next_fraction(const JammingEstimate& estimate, const LawForm& form,
                                           const std::vector<double>& proposed);

struct ProposedPoints {
  std::vector<ProposedPoint> points;
  double cpu_seconds = 0;      // of one of them at all curves, as the dearest of each took
  std::string obstacle{};      // why there are none, or no more
  Json patch = Json::array();  // RFC 6902, of the campaign file
};

// One after the other, turn by turn of the curves: as many as `cpu_seconds` pay, one a curve unless given, 20
// at most.
ProposedPoints propose_points(const std::vector<JammingEstimate>& estimates, const LawForm& form,
                              std::optional<double> cpu_seconds);

// The operations that add the fractions to the entry of a sweep that sets `over`, and the sweep with them.
struct SweepChange {
  Json patch = Json::array(), sweep;
};
// Throws InputError at /sweep/N of `file` for an entry that sets it in step with others, whose values nobody
// knows at new fractions, or where no entry sets it.
SweepChange add_to_sweep(const Json& sweep, const std::string& over, const std::vector<ProposedPoint>& points,
                         const std::string& file);

}  // namespace peclet::runner
