// `peclet jamming`: the jamming point of a campaign's curves, and which volume fractions would tell more.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runner/jamming/report.h"

namespace peclet::runner {

struct JammingOptions {
  std::filesystem::path campaign, directory;
  CurveChoice curves;
  EstimateChoice estimate;
  std::string by;  // "law", "steepest"; "" for both
  bool propose = false;
  std::optional<double> budget;  // seconds of processor time of what is proposed
  std::filesystem::path write;   // campaign file with the proposed points; "": none
  bool json = false;
};

struct JammingAnswer {
  std::string text;     // for standard output
  std::string message;  // for standard error
};

// Writes nothing but `write`, which must not be there yet. Throws as open_campaign() and read_curves(), and
// InputError for options that do not go together, for a sweep that cannot be added to, and for `write`.
JammingAnswer find_jamming(const JammingOptions& options);

}  // namespace peclet::runner
