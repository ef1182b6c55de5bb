// The bits of a value of doubles and integers, for comparisons in which -0 and 0 differ.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace peclet::engine {

template <class Value>
auto bits_of(const Value& value) {
  return std::bit_cast<std::array<std::uint32_t, sizeof(Value) / sizeof(std::uint32_t)>>(value);
}

}  // namespace peclet::engine
