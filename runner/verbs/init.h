// The verb `peclet init`: a campaign file to begin with.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

struct InitOptions {
  std::filesystem::path campaign;  // file to write
};

// Writes a small campaign that runs as it is: a Brownian suspension in the usual units of the literature,
// three Péclet numbers. Returns what to do next. Throws InputError when there is such a file already or its
// name is no campaign's, std::system_error when it cannot be written.
std::string init_campaign(const InitOptions& options);

}  // namespace peclet::runner
