// Faults of the fake engine, chosen by the environment.
//
// PECLET_FAKE_FAULTS lists what happens to which seed, and for how many of its tries (all, without a number):
// "crash:3 hang:4x1 overlap:7". The faults are
//   crash      abort() half-way                      exit     exit(3) half-way
//   kill       SIGKILL of itself half-way            hang     alive, but no further step
//   garble     bytes that are not a frame            refuse   a "failed" frame
//   overlap    the verdict of a blow-up              lie      a result whose hash is wrong
//   mute       dies between spool file and frame     twice    the result frame comes twice
//   swap       another seed's result                 nan      a result that is not a number
//   early      the result frame before the file      late     progress of the job after its result
//   truncate   half a result frame, then exit(0)     oversize a frame that announces 100 MiB
//   rehello    says hello once more half-way
//   lose       lists files that are not there        tamper   files with other bytes than are listed
//   escape     lists files by a path
// PECLET_FAKE_FAULT_STEP is another step for what happens half-way.
// PECLET_FAKE_CRASH_PROBABILITY crashes any try with this probability, drawn from point, seed and number of
// the try.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace peclet::fake {

enum class Fault {
  none,
  crash,
  exit,
  kill,
  hang,
  garble,
  refuse,
  overlap,
  lie,
  mute,
  twice,
  swap,
  nan,
  early,
  late,
  truncate,
  oversize,
  rehello,
  lose,
  tamper,
  escape
};

// Returns the number of this try of a seed, from 1, which it counts in a file of `folder` if there are
// faults.
int count_try(const std::filesystem::path& folder, const std::string& point, int seed);

// Returns the fault of this try. Throws std::runtime_error for an environment that makes no sense.
Fault fault_of(const std::string& point, int seed, int tried);

// Returns an environment variable as a number.
double setting(const char* name, double otherwise);

// Takes one step of splitmix64: the fake's dynamics and its dice. A bijection with full avalanche.
std::uint64_t mix(std::uint64_t state);

// Returns the first 64 bits of a text's SHA-256.
std::uint64_t first_bits(const std::string& text);

}  // namespace peclet::fake
