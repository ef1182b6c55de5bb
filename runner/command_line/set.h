// The verb `peclet set`: another target, other points, other priorities, also while the campaign runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/command_line/ask_owner.h"

namespace peclet::runner {

struct SetOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  std::optional<double> tolerance, absolute_tolerance, confidence;  // of /target
  std::optional<int> minimum, maximum;                              // of /realisations
  std::optional<int> realisations;                                  // /realisations, where it is a number
  std::optional<std::string> keep_files;                            // /keep_files, as a word
  std::vector<std::string> points;                                  // whose priority is set
  std::optional<int> priority;
  double patience = usual_patience;
};

// Changes these values in the text of the campaign file, of which nothing else changes, and has the campaign
// take the file over as it is then: the file stays what counts, and a later `peclet run` undoes nothing. A
// campaign that has not been run is changed in its file alone. A priority is no part of the file. Throws
// InputError, with nothing written, for a file that `peclet run` would refuse; as await_reply().
Reply set_campaign(const SetOptions& options);

}  // namespace peclet::runner
