// `peclet jamming`: the jamming point of a campaign's curves, and which volume fractions would tell more.
//
// The fits, the proposal and the texts are in python/peclet/jamming.py and jamming_report.py. The latter runs
// as a child: it reads one document of curves and options and writes one answer.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runner/jamming/curves.h"

namespace peclet::runner {

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
