// Trajectories as texts: the verb `peclet-engine trajectory`.
#pragma once

#include <string>

namespace peclet::engine {

struct ConversionOptions {
  std::string file;
  std::string format;  // "lammps", "xyz"; empty: what the name of the output ends in
  std::string output;  // empty: standard output
  std::string frames = "0:-1";
};

// Reads every frame that is chosen before anything is written. Returns what there is to say of the file, if
// anything. Throws InputError, std::system_error.
std::string convert_trajectory(const ConversionOptions& options);

}  // namespace peclet::engine
