// The verb `peclet validate`: everything that can be said about a campaign before anything is written.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

struct ValidateOptions {
  std::filesystem::path campaign;
  bool json = false;
};

// Reads the campaign and asks the engine about the scene of every point: derived groups, step, warnings.
// Throws InputError for the first fault, of the campaign or of a scene.
std::string validate_campaign(const ValidateOptions& options);

}  // namespace peclet::runner
