// Tables of keys of what programs exchange: the frames between runner and engine, and an engine's result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "contract/key_table.h"

namespace peclet {

// Seeds of a point lie in [0, most_realisations).
constexpr int most_realisations = 1'000'000;
// Bound on the magnitude of every number in a result: sums, squares and cubes of such values do not overflow.
constexpr double largest_number = 1e100;
// Bounds on the number of files beside a result, and on the size of each [bytes].
constexpr std::size_t most_left_files = 16;
constexpr std::uint64_t largest_left_file = std::uint64_t{1} << 32;
// Phases of a job, in their order.
constexpr std::array<const char*, 3> job_phases{"packing", "equilibration", "production"};

// Returns the keys of a result. Unknown members of results and frames are ignored.
const KeyTable& result_keys();

// Returns the keys of frames, one table for each "type".
const KindTables& frame_keys();
// Returns the frame with its defaults filled in. Throws FrameError if it does not match its keys.
Json checked_frame(Json message);

}  // namespace peclet
