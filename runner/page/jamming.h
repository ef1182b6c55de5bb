// The points of a campaign as curves of viscosity over volume fraction, each point with what is known of
// whether it flows.
//
// A point is judged by the seeds of its last stop test, before the first one by all that have ended:
// clang-format off
//   suspect        a seed gave two different results
//   open           no seed has ended
//   jammed         half of the seeds or more have jammed, as of Endings
//   lost           half or more ended without a value for other reasons
//   partly jammed  more than a tenth have jammed, as of Endings: the mean is of those that happened to flow
//   soft           contacts overlap by more than the limit in the mean: spheres that are not hard flow beyond
//                  their jamming point. Where results have no mean overlap, the largest of a seed, mean over
//                  the seeds, is above ten times the limit
//   flowing        all others
// clang-format on
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct CurveChoice {
  std::string over = "volume_fraction";         // as of chosen_axis()
  std::string quantity = "relative_viscosity";  // as `export` calls it
  double softest = 0.001;                       // overlap
};

// Returns {"campaign", "quantity", "over": pointer of the volume fraction, "curves"}. A curve has a "name",
// as "μ = 0.5" or "friction = 0.5" ("" of the only one), "settings" of what is swept besides, by pointer, and
// "points" in ascending order of "fraction": their "label" and "state"; "mean", "standard_error" and "count"
// of the viscosity, of the estimate that decides; "seeds" that have ended and that have "jammed"; "overlap"
// and "largest_overlap", in radii of the smaller sphere, means over the seeds: of contacts, and the largest;
// "cpu_seconds" of all seeds. Numbers that do not exist are null.
//
// Throws InputError for a parameter that is not swept or is no volume fraction (0 < phi < 1), or a quantity
// that is not measured; IntegrityError.
Json read_curves(Database& database, const CurveChoice& choice);

// `peclet jamming`: the jamming point of a campaign's curves, and which volume fractions would tell more.
//
// The fits, the proposal and the texts are in python/peclet/jamming.py and jamming_report.py. The latter runs
// as a child: it reads one document of curves and options and writes one answer.
struct JammingOptions {
  std::filesystem::path campaign, directory;
  CurveChoice curves;
  std::string by;                  // "law", "steepest"; "" for both
  std::optional<double> exponent;  // of the law, if it is given
  bool common_exponent = false;    // one for all curves; then `exponent` is absent
  bool unit_prefactor = false;     // the law's prefactor is 1
  double above = 10;               // least viscosity of the points of the law
  bool propose = false;
  std::optional<double> budget;  // seconds of processor time of what is proposed
  std::filesystem::path write;   // campaign file with the proposed points; "": none
  bool json = false;
};

struct JammingAnswer {
  std::string text;     // for standard output
  std::string message;  // for standard error
};

// Writes nothing but `write`, which must not be there yet. Throws as open_campaign() and read_curves(),
// InputError for options that do not go together, for a sweep that cannot be added to, and for `write`, and
// std::runtime_error if the fits cannot run.
JammingAnswer find_jamming(const JammingOptions& options);

}  // namespace peclet::runner
