// The verbs `peclet init` and `peclet validate`: a campaign before anything has run.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

// The verb `peclet init`: a campaign file to begin with.
struct InitOptions {
  std::filesystem::path campaign;  // file to write
};

// Writes a small campaign that runs as it is: a Brownian suspension in the usual units of the literature,
// three Péclet numbers. Returns what to do next. Throws InputError when there is such a file already or its
// name is no campaign's, std::system_error when it cannot be written.
std::string init_campaign(const InitOptions& options);

// The verb `peclet validate`: everything that can be said about a campaign before anything is written.
struct ValidateOptions {
  std::filesystem::path campaign;
  bool json = false;
};

// Reads the campaign and asks the engine about the scene of every point: derived groups, step, warnings.
// Throws InputError for the first fault, of the campaign or of a scene.
std::string validate_campaign(const ValidateOptions& options);

}  // namespace peclet::runner
