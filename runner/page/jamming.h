// The points of a campaign as curves of viscosity over volume fraction, each point with its state.
//
// The state follows from the seeds of the last stop test, or before the first one from all that have ended:
// clang-format off
//   suspect        a seed gave two different results
//   open           no seed has ended
//   jammed         half of the seeds or more have jammed (see Endings)
//   lost           half or more ended without a value for other reasons
//   partly jammed  more than a tenth have jammed: the mean is that of the seeds that happened to flow
//   soft           contacts overlap by more than the limit in the mean; soft spheres flow beyond their
//                  jamming point. If results have no mean overlap: the largest overlap of a seed, averaged
//                  over the seeds, exceeds ten times the limit
//   flowing        all others
// clang-format on
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/reports/proposed_file.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct CurveChoice {
  std::string over = "volume_fraction";         // as in chosen_axis()
  std::string quantity = "relative_viscosity";  // as `export` calls it
  double softest = 0.001;  // mean overlap of contacts [radii] above which a point is soft
};

// Returns {"campaign", "quantity", "over": pointer of the volume fraction, "curves"}. A curve has
// clang-format off
//   name      "μ = 0.5" or "friction = 0.5"; "" for a single curve
//   settings  values of the other swept parameters, by pointer
//   points    in ascending order of "fraction"
// and a point, with null for numbers that do not exist,
//   label, state
//   mean, standard_error, count  of the viscosity: the estimate that decides
//   seeds, jammed                seeds that have ended, and those that have jammed
//   overlap, largest_overlap     of contacts, and the largest one; means over the seeds [smaller radii]
//   cpu_seconds                  processor time of all seeds
// clang-format on
// Throws InputError for a parameter that is not swept or is not a volume fraction (0 < phi < 1), or a
// quantity that is not measured. Throws IntegrityError.
Json read_curves(Database& database, const CurveChoice& choice);

// `peclet jamming`: the jamming point of a campaign's curves, and which volume fractions would tell more.
//
// The fits, the proposal and the texts are in python/peclet/jamming.py and jamming_report.py, which runs as a
// child (package_module.h).
struct JammingOptions {
  std::filesystem::path campaign, directory;
  CurveChoice curves;
  std::string by;                  // "law", "steepest"; "" for both
  std::optional<double> exponent;  // exponent of the law; absent: fitted
  bool common_exponent = false;    // one for all curves; then `exponent` is absent
  bool unit_prefactor = false;     // the law's prefactor is 1
  double above = 10;               // viscosity above which points enter the law
  bool propose = false;
  std::optional<double> budget;  // processor time for the proposed points [s]
  std::filesystem::path write;   // campaign file with the proposed points; "": none
  bool json = false;
};

// Runs the fits and returns their texts. Writes nothing but the file `write`, which must not exist. Throws as
// open_campaign() and read_curves(); InputError for options that exclude each other, for a sweep to which
// points cannot be added, and for `write`; std::runtime_error if the fits cannot run.
Proposal find_jamming(const JammingOptions& options);

}  // namespace peclet::runner
