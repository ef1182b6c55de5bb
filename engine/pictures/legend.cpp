#include "engine/pictures/legend.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace peclet::engine {
namespace {

const Colour& ink() {
  static const Colour dark = colour_of(0x333a44);
  return dark;
}

// Texts of 0.1 and 0.30000000000000004 alike.
std::string text_of(double value) { return fmt::format("{:.6g}", value); }

void draw_scale(Canvas& canvas, const Layout& layout, const ColourScale& scale) {
  const double length = 0.5 * layout.height, left = std::round(layout.legend.left),
               right = left + std::round(1.1 * layout.letters);
  const double top = std::round(0.5 * (layout.height - length)), bottom = top + std::round(length);
  for (double y = top; y < bottom; ++y) {
    const double share = (bottom - y - 0.5) / (bottom - top);
    draw_box(canvas, {left, y}, {right, y + 1}, viridis(share));
  }
  for (const double tick : ticks_of(scale)) {
    const double y = bottom - (tick - scale.low) / (scale.high - scale.low) * (bottom - top);
    draw_line(canvas, {right, y}, {right + 0.35 * layout.letters, y}, 0.09 * layout.letters, ink());
    draw_text(canvas, {right + 0.7 * layout.letters, y + 0.5 * layout.letters}, layout.letters, text_of(tick),
              ink());
  }
  draw_text(canvas, {left, top - 1.2 * layout.letters}, layout.letters, scale.title, ink());
}

void draw_names(Canvas& canvas, const Layout& layout, const std::vector<NamedColour>& names) {
  const double row = 2.2 * layout.letters;
  double y = 0.5 * (layout.height - row * static_cast<double>(names.size() - 1));
  for (const NamedColour& name : names) {
    draw_disc(canvas, {layout.legend.left + 0.7 * layout.letters, y}, 0.7 * layout.letters, name.colour);
    draw_text(canvas, {layout.legend.left + 2.1 * layout.letters, y + 0.5 * layout.letters}, layout.letters,
              name.name, ink());
    y += row;
  }
}

}  // namespace

Layout::Layout(std::size_t w, std::size_t h)
    : width(static_cast<double>(w)),
      height(static_cast<double>(h)),
      margin(0.03 * height),
      letters(0.0195 * height) {
  const double side = std::min(14 * letters, 0.3 * width);
  spheres = {margin, margin, width - margin - side, height - margin};
  legend = {width - side, margin, width - margin, height - margin};
}

void draw_legend(Canvas& canvas, const Layout& layout, const Colouring& colouring) {
  for (const ColourScale& scale : colouring.scale) draw_scale(canvas, layout, scale);
  if (!colouring.names.empty()) draw_names(canvas, layout, colouring.names);
}

void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& text) {
  const double length = 3 * layout.letters;
  const Spot origin = {layout.legend.left + 1.5 * layout.letters,
                       layout.height - layout.margin - 1.5 * layout.letters};
  const std::array<std::pair<const char*, Vector3>, 3> axes = {
      {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}}};
  for (const auto& [name, direction] : axes) {
    const Vector3 seen = camera.turned(direction);
    const double size = std::hypot(seen.x, seen.y);
    if (size < 0.1) continue;  // along the line of sight
    const Spot end = {origin.x + length * seen.x, origin.y - length * seen.y};
    draw_line(canvas, origin, end, 0.12 * layout.letters, ink());
    const double beyond = 1 + 0.3 / size;
    const double half = 0.5 * width_of_text(name, layout.letters);
    draw_text(canvas,
              {origin.x + beyond * length * seen.x - half,
               origin.y - beyond * length * seen.y + 0.4 * layout.letters},
              layout.letters, name, ink());
  }
  draw_text(canvas, {layout.legend.left, layout.margin + layout.letters}, layout.letters, text, ink());
}

}  // namespace peclet::engine
