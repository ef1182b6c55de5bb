#include "engine/pictures/ink.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace peclet::engine {
namespace {

constexpr double capitals = 21, base_line = 9;  // in units of the letters

// Mixes `colour` into each pixel by the pixel's share inside the edge, estimated from the distance of its
// centre from the edge (positive outside).
template <class Distance>
void cover(Canvas& canvas, Spot low, Spot high, const Colour& colour, const Distance& distance) {
  const auto within = [](double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count)));
  };
  for (std::size_t y = within(low.y - 1, canvas.height); y < within(high.y + 2, canvas.height); ++y) {
    for (std::size_t x = within(low.x - 1, canvas.width); x < within(high.x + 2, canvas.width); ++x) {
      const double d = distance(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
      const double share = std::clamp(0.5 - d, 0.0, 1.0);
      if (share > 0) canvas.at(x, y) = mixed(canvas.at(x, y), colour, static_cast<float>(share));
    }
  }
}

const char* strokes_of(char letter) {
  const auto place = static_cast<std::size_t>(static_cast<unsigned char>(letter)) - ' ';
  return hershey_simplex[place < hershey_simplex.size() ? place : '?' - ' '];
}

double width_of(const char* strokes) { return strokes[1] - strokes[0]; }

void append_big_endian(std::string& text, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift);
}

// Appends length, name, content, and the checksum of name and content.
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

// Returns the rows after the filter "Paeth", which predicts bytes by their neighbours: good for soft shades.
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

Image Canvas::image() const {
  Image image{width, height, {}};
  image.rgb.reserve(3 * pixel.size());
  for (const Colour& p : pixel) {
    for (const float part : {p.red, p.green, p.blue}) image.rgb.push_back(encoded(part));
  }
  return image;
}

void draw_line(Canvas& canvas, Spot from, Spot to, double width, const Colour& colour) {
  const double dx = to.x - from.x, dy = to.y - from.y, square = dx * dx + dy * dy, half = width / 2;
  cover(canvas, {std::min(from.x, to.x) - half, std::min(from.y, to.y) - half},
        {std::max(from.x, to.x) + half, std::max(from.y, to.y) + half}, colour, [&](double x, double y) {
          const double along =
              square > 0 ? std::clamp(((x - from.x) * dx + (y - from.y) * dy) / square, 0.0, 1.0) : 0;
          return std::hypot(x - from.x - along * dx, y - from.y - along * dy) - half;
        });
}

void draw_disc(Canvas& canvas, Spot centre, double radius, const Colour& colour) {
  draw_line(canvas, centre, centre, 2 * radius, colour);
}

void draw_box(Canvas& canvas, Spot corner, Spot opposite, const Colour& colour) {
  cover(canvas, corner, opposite, colour, [&](double x, double y) {
    return std::max({corner.x - x, x - opposite.x, corner.y - y, y - opposite.y});
  });
}

double width_of_text(std::string_view text, double height) {
  double width = 0;
  for (const char letter : text) width += width_of(strokes_of(letter));
  return width * height / capitals;
}

void draw_text(Canvas& canvas, Spot line, double height, std::string_view text, const Colour& colour) {
  const double unit = height / capitals, width = 0.105 * height;
  double left = line.x;
  for (const char letter : text) {
    const char* const strokes = strokes_of(letter);
    const char* last = nullptr;
    const auto spot = [&](const char* pair) {
      return Spot{left + unit * (pair[0] - strokes[0]), line.y + unit * (pair[1] - 'R' - base_line)};
    };
    for (const char* pair = strokes + 2; *pair != '\0'; pair += 2) {
      const bool lifts = pair[0] == ' ';
      if (!lifts && last != nullptr) draw_line(canvas, spot(last), spot(pair), width, colour);
      last = lifts ? nullptr : pair;
    }
    left += unit * width_of(strokes);
  }
}

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
