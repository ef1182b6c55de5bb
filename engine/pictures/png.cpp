#include "engine/pictures/png.h"

#include <zlib.h>

#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace peclet::engine {
namespace {

void append_big_endian(std::string& text, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift);
}

// Length, name, content and checksum, which is that of name and content.
void append_chunk(std::string& file, std::string_view name, std::string_view content) {
  append_big_endian(file, static_cast<std::uint32_t>(content.size()));
  const std::string checked = std::string(name) + std::string(content);
  file += checked;
  append_big_endian(file,
                    static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                                       static_cast<uInt>(checked.size()))));
}

std::uint8_t paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - corner);
  return static_cast<std::uint8_t>(a <= b && a <= c ? left : b <= c ? above : corner);
}

// Each byte less what its neighbours let expect of it, by the filter "Paeth", which suits soft shades.
std::string filtered(const Image& image) {
  constexpr std::size_t channels = 3;
  const std::size_t length = channels * image.width;
  std::string rows;
  rows.reserve(image.height * (length + 1));
  for (std::size_t y = 0; y < image.height; ++y) {
    const std::uint8_t* const row = image.rgb.data() + y * length;
    const std::uint8_t* const above = y > 0 ? row - length : nullptr;
    rows += '\4';
    for (std::size_t x = 0; x < length; ++x) {
      const int left = x >= channels ? row[x - channels] : 0;
      const int over = above != nullptr ? above[x] : 0;
      const int corner = above != nullptr && x >= channels ? above[x - channels] : 0;
      rows += static_cast<char>(row[x] - paeth(left, over, corner));
    }
  }
  return rows;
}

}  // namespace

std::string png(const Image& image) {
  const std::string rows = filtered(image);
  uLongf length = ::compressBound(rows.size());
  std::string deflated(length, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(deflated.data()), &length,
                  reinterpret_cast<const Bytef*>(rows.data()), rows.size(), 6) != Z_OK) {
    throw std::runtime_error("zlib cannot deflate the picture");
  }
  deflated.resize(length);
  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(image.width));
  append_big_endian(header, static_cast<std::uint32_t>(image.height));
  header +=
      std::string("\x08\x02\0\0\0", 5);  // 8 bits of red, green and blue; deflate, filters, no interlacing
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", header);
  append_chunk(file, "sRGB", std::string_view("\0", 1));  // perceptual
  append_chunk(file, "IDAT", deflated);
  append_chunk(file, "IEND", "");
  return file;
}

}  // namespace peclet::engine
