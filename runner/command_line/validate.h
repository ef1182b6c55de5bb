// The verbs `peclet init` and `peclet validate`, for a campaign before its first run.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

struct InitOptions {
  std::filesystem::path campaign;  // file to write
};

// Writes a small campaign that runs as it is: a Brownian suspension at three Péclet numbers, in the usual
// units of the literature. Returns the message with the next commands. Throws InputError if the file exists
// or its name cannot be that of a campaign, std::system_error if it cannot be written.
std::string init_campaign(const InitOptions& options);

struct ValidateOptions {
  std::filesystem::path campaign;
  bool json = false;
};

// Reads the campaign, asks the engine about the scene of every point, and returns a table (or JSON) of
// derived groups, time steps and warnings. Throws InputError for the first fault. Writes nothing.
std::string validate_campaign(const ValidateOptions& options);

}  // namespace peclet::runner
