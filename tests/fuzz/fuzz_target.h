// The interface of a fuzz target: an untrusted kind of input, given to the code that reads it.
//
// A target defines what is declared here. Linked with keyed_mutations.cpp it is a program that tests run;
// with clang's libFuzzer it is a long search (libfuzzer.sh).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Reads one input and returns 0. Catches the exceptions that are allowed. Any other exception, a sanitizer's
// fault or an endless loop is a finding. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// The number of inputs read completely; the target counts them.
extern std::size_t inputs_accepted;

// Returns inputs that are read completely, the start of mutations.
std::vector<std::string> valid_inputs();
