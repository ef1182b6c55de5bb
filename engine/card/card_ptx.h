// The card's program as PTX, one text for each variant, packed into this program. cmake/card_programs.cmake
// compiles them.
#pragma once

#include <string>
#include <string_view>

namespace peclet::engine {

// Returns the PTX of a variant from 0 to PECLET_CARD_VARIANTS - 1, which ends in a zero as a C string.
// Returns an empty text for other numbers, and if no clang was there to compile it.
std::string_view card_ptx(unsigned variant);

// Returns the SHA-256 of all variants, in their order; empty if there are none.
std::string card_ptx_sha256();

}  // namespace peclet::engine
