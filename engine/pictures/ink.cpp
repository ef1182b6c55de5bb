#include "engine/pictures/ink.h"

#include <algorithm>
#include <cmath>

namespace peclet::engine {
namespace {

constexpr double capitals = 21, base_line = 9;  // in units of the letters

// Mixes `colour` into each pixel by its share that `distance`, of the pixel's centre from the edge, positive
// outside, lets expect.
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

}  // namespace peclet::engine
