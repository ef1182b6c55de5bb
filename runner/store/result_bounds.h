// How large the text of a result may be: judged before it is read as JSON, which takes memory in proportion.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace peclet::runner {

// Of a result's text. Most have some ten thousand bytes and a few thousand values; a pair distribution in the
// plane of shear may have four million numbers. Lists, objects and keys take more memory than numbers do.
constexpr std::size_t largest_result = std::size_t{64} << 20;
constexpr std::size_t most_values = std::size_t{1} << 22;
constexpr std::size_t most_structures = std::size_t{1} << 19;
constexpr int deepest_result = 200;

// "" when the text keeps within these bounds, otherwise what it exceeds. It need not be JSON.
std::string excess_of(std::string_view text);

}  // namespace peclet::runner
