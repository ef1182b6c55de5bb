// Requests at random to the server of `peclet serve`, and what each of its answers has to be.
//
// A request is made of one that is kept by up to eight changes: bytes changed, put in, taken out, repeated,
// exchanged with another request. One with an answer of a kind that was not seen before is kept. The sequence
// follows from the seed alone. Sanitizers see faults of memory; the rest is asked here.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace peclet::runner {

struct FuzzReport {
  std::int64_t requests = 0;
  std::size_t answers = 0;            // different answers, by status, type and method
  std::vector<std::string> findings;  // what an answer was not, with the request in JSON's spelling
};

// Asks until `goes_on` is false, or ten findings were made.
FuzzReport fuzz_live_server(std::uint64_t seed, const std::function<bool(const FuzzReport&)>& goes_on);

}  // namespace peclet::runner
