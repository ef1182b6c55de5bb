// What programs say to each other: the frames between runner and engine, and the result that an engine
// leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "contract/key_table.h"

namespace peclet {

// Seeds of a point are 0 to most_realisations - 1.
constexpr int most_realisations = 1'000'000;
// No number of a result is larger, so that no sum, square or cube of a campaign's values overflows.
constexpr double largest_number = 1e100;
constexpr std::size_t most_left_files = 16;
constexpr std::uint64_t largest_left_file = std::uint64_t{1} << 32;
// The phases of a job, in their order.
constexpr std::array<const char*, 3> job_phases{"packing", "equilibration", "production"};

// Keys of a result. Receivers ignore members that they do not know, here and in frames.
const KeyTable& result_keys();

// Keys of frames, by their "type".
const KindTables& frame_keys();
// Returns the frame with its defaults. Throws FrameError if it does not match its keys.
Json checked_frame(Json message);

}  // namespace peclet
