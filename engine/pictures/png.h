// PNG files (ISO/IEC 15948), which zlib deflates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace peclet::engine {

// Red, green and blue of sRGB, row after row from the top.
struct Image {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// Requires 3 width height numbers, and sides of 1 to 2^31 - 1.
std::string png(const Image& image);

}  // namespace peclet::engine
