#include "runner/figure/legend.h"

#include <fmt/format.h>

#include <algorithm>

namespace peclet::runner {
namespace {

constexpr double line_height = 20, margin = 8, sign_width = 26;
constexpr int text_size = 13;

}  // namespace

Legend::Legend(const Figure& figure) {
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    if (!figure.curves[i].name.empty()) items_.push_back({Sign::curve, i, figure.curves[i].name});
  }
  if (figure.has(Standing::undecided)) items_.push_back({Sign::hollow, 0, {{"not converged"}}});
  if (figure.has(Standing::provisional)) items_.push_back({Sign::dashed, 0, {{"provisional"}}});
  if (figure.has_jammed()) items_.push_back({Sign::cross, 0, {{"jammed"}}});
  if (figure.tolerance) items_.push_back({Sign::band, 0, {{"tolerance"}}});
  for (const Item& item : items_) width_ = std::max(width_, text_width(item.text, text_size));
  width_ += sign_width + 2 * margin;
}

double Legend::height() const { return line_height * static_cast<double>(items_.size()) + margin; }

LegendPlace Legend::place(const Box& frame, const std::vector<Box>& drawn) const {
  constexpr double inner = 6;
  const double left = frame.left + inner, right = frame.right - inner - width_;
  const double top = frame.top + inner, bottom = frame.bottom - inner - height();
  const bool fits = left <= right && top <= bottom;
  for (const LegendPlace& place : {LegendPlace{"upper left", {left, top}},
                                   {"upper right", {right, top}},
                                   {"lower right", {right, bottom}},
                                   {"lower left", {left, bottom}}}) {
    const Place& corner = place.corner;
    const Box own{corner.x, corner.y, corner.x + width_, corner.y + height()};
    const auto covers = [&](const Box& box) { return own.meets(box); };
    if (fits && std::none_of(drawn.begin(), drawn.end(), covers)) return place;
  }
  return {"beside", {frame.right + inner, frame.top}};
}

std::string Legend::svg(Place corner) const {
  std::string text;
  double y = corner.y + margin / 2 + line_height / 2;
  for (const Item& item : items_) {
    const Place sign{corner.x + margin + 8, y};
    const char* const colour = figure_colours.at(item.curve % figure_colours.size());
    if (item.sign == Sign::band) {
      text += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"16\" height=\"12\" fill=\"{}\" fill-opacity=\"0.16\"/>\n",
          svg_number(sign.x - 8), svg_number(y - 6), colour);
    } else if (item.sign == Sign::cross) {
      text += svg_cross(item.curve, sign);
    } else {
      if (item.sign == Sign::dashed) {
        const std::string style = fmt::format("stroke=\"{}\" stroke-dasharray=\"3 2\"", colour);
        text += svg_line({sign.x, y - 9}, {sign.x, y + 9}, style);
      }
      text += svg_mark(item.curve, sign, item.sign != Sign::curve);
    }
    text += svg_text(item.text, {corner.x + margin + sign_width, y + 4.5}, Anchor::start, text_size);
    y += line_height;
  }
  return text;
}

}  // namespace peclet::runner
