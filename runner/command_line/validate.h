// The verb `peclet validate`, for a campaign before its first run.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

struct ValidateOptions {
  std::filesystem::path campaign;
  bool json = false;
};

// Reads the campaign, asks the engine about the scene of every point, and returns a table (or JSON) of
// derived groups, time steps and warnings. Throws InputError for the first fault. Writes nothing.
std::string validate_campaign(const ValidateOptions& options);

}  // namespace peclet::runner
