// One kind of input that comes from strangers, given to the code that reads it.
//
// A target defines both functions. With keyed_mutations.cpp it is a program of its own, which tests run; with
// clang's libFuzzer it is a long search (libfuzzer.sh).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Reads one input. What it may throw is caught in it: whatever else leaves it, a fault that a sanitizer sees,
// or an endless loop is a finding. Returns 0. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// The number of inputs that were read as a whole. The target counts them.
extern std::size_t inputs_accepted;

// Returns inputs that are read as a whole, from which mutations begin.
std::vector<std::string> valid_inputs();
