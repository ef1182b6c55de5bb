#include "runner/figure/svg_text.h"

#include <fmt/format.h>

#include <cmath>

#include "runner/text/html.h"

namespace peclet::runner {
namespace {

// Corners around the middle, for a radius of 1; none: a circle. As many as are not confused with each other.
const std::array<std::vector<Place>, figure_shapes> shapes{
    {{},
     {{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}},
     {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}},
     {{0, -1.2}, {1.2, 1}, {-1.2, 1}},
     {{0, 1.2}, {1.2, -1}, {-1.2, -1}},
     {{-0.4, -1.2},
      {0.4, -1.2},
      {0.4, -0.4},
      {1.2, -0.4},
      {1.2, 0.4},
      {0.4, 0.4},
      {0.4, 1.2},
      {-0.4, 1.2},
      {-0.4, 0.4},
      {-1.2, 0.4},
      {-1.2, -0.4},
      {-0.4, -0.4}},
     {{-1.2, 0}, {-0.6, -1.05}, {0.6, -1.05}, {1.2, 0}, {0.6, 1.05}, {-0.6, 1.05}}}};

const char* name_of(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return count;
}

}  // namespace

std::string svg_number(double value) {
  const double tenths = std::round(value * 10) / 10;
  return fmt::format("{}", tenths == 0 ? 0.0 : tenths);
}

std::string svg_line(Place from, Place to, const std::string& style) {
  return fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", svg_number(from.x),
                     svg_number(from.y), svg_number(to.x), svg_number(to.y), style);
}

std::string svg_path(const std::vector<Place>& places, bool closed, const std::string& style) {
  std::string path;
  for (const Place& place : places) {
    path += fmt::format("{}{} {}", path.empty() ? 'M' : 'L', svg_number(place.x), svg_number(place.y));
  }
  return fmt::format("<path d=\"{}{}\" {}/>\n", path, closed ? "Z" : "", style);
}

std::string svg_mark(std::size_t curve, Place centre, bool hollow) {
  constexpr double radius = 4.5;
  const char* const colour = figure_colours.at(curve % figure_colours.size());
  const std::string style = fmt::format("class=\"mark\" stroke=\"{}\" stroke-width=\"1.4\" fill=\"{}\"",
                                        colour, hollow ? "#ffffff" : colour);
  const std::vector<Place>& shape = shapes.at(curve % shapes.size());
  if (shape.empty()) {
    return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", svg_number(centre.x),
                       svg_number(centre.y), radius, style);
  }
  std::vector<Place> corners;
  corners.reserve(shape.size());
  for (const Place& corner : shape)
    corners.push_back({centre.x + radius * corner.x, centre.y + radius * corner.y});
  return svg_path(corners, true, style);
}

std::string svg_cross(std::size_t curve, Place centre) {
  constexpr double reach = 5;
  const std::string style = fmt::format("class=\"jammed\" stroke=\"{}\" stroke-width=\"2\"",
                                        figure_colours.at(curve % figure_colours.size()));
  return svg_line({centre.x - reach, centre.y - reach}, {centre.x + reach, centre.y + reach}, style) +
         svg_line({centre.x - reach, centre.y + reach}, {centre.x + reach, centre.y - reach}, style);
}

std::string svg_text(const Label& label, Place at, Anchor anchor, int size, bool upright) {
  std::string spans;
  int shift = 0;
  for (const LabelPart& part : label) {
    const int wanted = part.level > 0 ? -size * 2 / 5 : part.level < 0 ? size * 3 / 10 : 0;
    spans += "<tspan";
    if (part.level != 0) spans += fmt::format(" font-size=\"{}\"", size * 3 / 4);
    if (wanted != shift) spans += fmt::format(" dy=\"{}\"", wanted - shift);
    spans += '>' + escaped(part.text) + "</tspan>";
    shift = wanted;
  }
  const std::string where =
      upright ? fmt::format("transform=\"translate({} {}) rotate(-90)\"", svg_number(at.x), svg_number(at.y))
              : fmt::format("x=\"{}\" y=\"{}\"", svg_number(at.x), svg_number(at.y));
  return fmt::format("<text {} text-anchor=\"{}\" font-size=\"{}\" xml:space=\"preserve\">{}</text>\n", where,
                     name_of(anchor), size, spans);
}

double text_width(const Label& label, int size) {
  double width = 0;
  for (const LabelPart& part : label) {
    width += static_cast<double>(characters(part.text)) * size * (part.level == 0 ? 0.55 : 0.42);
  }
  return width;
}

}  // namespace peclet::runner
