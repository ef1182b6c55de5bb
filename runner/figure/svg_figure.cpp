#include "runner/figure/svg_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/figure/legend.h"
#include "runner/figure/svg_text.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

constexpr double whole_width = 620, least_height = 430;
constexpr double least_beside = 76, below = 56, around = 16;  // of the frame
constexpr std::size_t most_across = 8, most_up = 8;           // ticks
constexpr int tick_size = 13;

// The frame. Numbers at the ticks make room for themselves between it and the title; a legend that stands
// beside it widens the picture.
Box frame_of(const Figure& figure, const Legend& legend) {
  constexpr double title_end = 32, tick_gap = 7;
  const double bottom = std::max(least_height, legend.height() + below + around) - below;
  double widest = 0;
  for (const double value : Axis(figure.y.range, bottom, around, most_up).ticks()) {
    widest = std::max(widest, text_width({{plain_number(value)}}, tick_size));
  }
  return {std::max(least_beside, title_end + widest + tick_gap), around, whole_width - around, bottom};
}

struct Axes {
  Axis x, y;
};

Axes axes_in(const Figure& figure, const Box& frame) {
  const std::size_t words = figure.x.words.size();
  return {words > 0 ? Axis(words, frame.left, frame.right)
                    : Axis(figure.x.range, frame.left, frame.right, most_across),
          Axis(figure.y.range, frame.bottom, frame.top, most_up)};
}

class Drawing {
 public:
  explicit Drawing(const Figure& figure)
      : figure_(figure), legend_(figure), frame_(frame_of(figure, legend_)), axes_(axes_in(figure, frame_)) {}

  std::string svg() {
    const std::string inside = curves();
    if (legend_.is_empty()) return whole(whole_width, inside);
    const LegendPlace place = legend_.place(frame_, drawn_);
    const double width = std::max(whole_width, place.corner.x + legend_.width());
    return whole(width, inside + legend_.svg(place.corner));
  }

  FigureLayout layout() {
    curves();
    return {axes_.x, axes_.y, legend_.place(frame_, drawn_).name};
  }

 private:
  std::string whole(double width, const std::string& inside) const {
    return head(width) + ticks() + inside + titles() + "</g>\n</svg>\n";
  }

  // Notes what is drawn where.
  std::string curves() {
    std::string text;
    const std::size_t count = figure_.curves.size();
    for (std::size_t i = 0; i < count && figure_.tolerance; ++i) text += band(i);
    for (std::size_t i = 0; i < count; ++i) text += guide(i);
    for (std::size_t i = 0; i < count; ++i) {
      for (const Mark& mark : figure_.curves[i].marks) text += drawn(i, mark);
    }
    return text;
  }

  std::string head(double width) const {
    const double height = frame_.bottom + below;
    const std::string title =
        fmt::format("{} over {}: {}", text_of(figure_.y.title), text_of(figure_.x.title), figure_.campaign);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "role=\"img\">\n<title>{2}</title>\n<desc>Bars are {3:g} % intervals; lines guide the eye. "
        "{4}</desc>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n"
        "<g font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" "
        "fill=\"#000000\">\n",
        svg_number(width), svg_number(height), escaped(title), 100 * figure_.confidence,
        escaped(left_out(figure_)));
  }

  // Inward, on all four sides, and numbers below and on the left.
  std::string ticks() const {
    constexpr double major = 6, minor = 3;
    std::string text;
    const auto across = [&](double value, double length) {
      const double x = axes_.x.place(value);
      text += svg_line({x, frame_.bottom}, {x, frame_.bottom - length}, ink);
      text += svg_line({x, frame_.top}, {x, frame_.top + length}, ink);
    };
    const auto upward = [&](double value, double length) {
      const double y = axes_.y.place(value);
      text += svg_line({frame_.left, y}, {frame_.left + length, y}, ink);
      text += svg_line({frame_.right, y}, {frame_.right - length, y}, ink);
    };
    for (const double value : axes_.x.minor_ticks()) across(value, minor);
    for (const double value : axes_.y.minor_ticks()) upward(value, minor);
    const std::vector<double> places = axes_.x.ticks();
    // Of words as many as have room.
    const double room =
        (frame_.right - frame_.left) / static_cast<double>(std::max<std::size_t>(1, places.size()));
    const auto step = figure_.x.words.empty() ? 1 : static_cast<std::size_t>(std::ceil(70 / room));
    for (std::size_t i = 0; i < places.size(); ++i) {
      across(places[i], major);
      if (i % step != 0) continue;
      const std::string word = figure_.x.words.empty() ? plain_number(places[i]) : figure_.x.words[i];
      text += svg_text({{word}}, {axes_.x.place(places[i]), frame_.bottom + 19}, Anchor::middle, tick_size);
    }
    for (const double value : axes_.y.ticks()) {
      upward(value, major);
      text += svg_text({{plain_number(value)}}, {frame_.left - 7, axes_.y.place(value) + 4.5}, Anchor::end,
                       tick_size);
    }
    return text;
  }

  std::string titles() const {
    return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" {}/>\n",
                       svg_number(frame_.left), svg_number(frame_.top),
                       svg_number(frame_.right - frame_.left), svg_number(frame_.bottom - frame_.top), ink) +
           svg_text(figure_.x.title, {(frame_.left + frame_.right) / 2, frame_.bottom + 44}, Anchor::middle,
                    15) +
           svg_text(figure_.y.title, {20, (frame_.top + frame_.bottom) / 2}, Anchor::middle, 15, true);
  }

  Place place(const Mark& mark) const {
    const double x = axes_.x.place(mark.x);
    if (mark.jam == Jam::above) return {x, frame_.top};
    if (mark.jam == Jam::below) return {x, frame_.bottom};
    return {x, axes_.y.place(mark.mean)};
  }

  std::string guide(std::size_t curve) {
    std::vector<Place> places;
    for (const Mark& mark : figure_.curves[curve].marks) {
      if (mark.jam == Jam::none) places.push_back(place(mark));
    }
    if (places.size() < 2) return "";
    for (std::size_t i = 1; i < places.size(); ++i) keep_clear(places[i - 1], places[i]);
    return svg_path(
        places, false,
        fmt::format("class=\"guide\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"0.6\"", colour(curve)));
  }

  std::string band(std::size_t curve) const {
    std::vector<Place> above, under;
    for (const Mark& mark : figure_.curves[curve].marks) {
      if (!mark.good_enough || mark.jam != Jam::none) continue;
      const double x = axes_.x.place(mark.x);
      above.push_back({x, axes_.y.clamped(mark.mean + *mark.good_enough)});
      under.push_back({x, axes_.y.clamped(mark.mean - *mark.good_enough)});
    }
    if (above.empty()) return "";
    if (above.size() == 1) {  // wide enough to be seen
      for (std::vector<Place>* side : {&above, &under}) {
        side->push_back({side->front().x + 12, side->front().y});
        side->front().x -= 12;
      }
    }
    above.insert(above.end(), under.rbegin(), under.rend());
    return svg_path(above, true,
                    fmt::format("class=\"band\" fill=\"{}\" fill-opacity=\"0.16\"", colour(curve)));
  }

  std::string drawn(std::size_t curve, const Mark& mark) {
    constexpr double cap = 4, room = 8;
    const Place centre = place(mark);
    const bool provisional = mark.standing == Standing::provisional;
    std::string text = fmt::format("<g><title>{}</title>\n", escaped(mark.label));
    const std::string style = fmt::format("class=\"bar\" stroke=\"{}\" stroke-width=\"1.4\"{}", colour(curve),
                                          provisional ? " stroke-dasharray=\"3 2\"" : "");
    Box box{centre.x - room, centre.y - room, centre.x + room, centre.y + room};
    if (mark.has_place() && std::isfinite(mark.half_width)) {
      for (const double end : {mark.mean - mark.half_width, mark.mean + mark.half_width}) {
        const double y = axes_.y.clamped(end);
        text += svg_line(centre, {centre.x, y}, style);
        // A bar that is cut off has no cap.
        const bool whole = !(axes_.y.is_log() && end <= 0) && std::abs(axes_.y.place(end) - y) < 0.05;
        if (whole) text += svg_line({centre.x - cap, y}, {centre.x + cap, y}, style);
        box = {box.left, std::min(box.top, y), box.right, std::max(box.bottom, y)};
      }
    }
    drawn_.push_back(box);
    return text +
           (mark.jam == Jam::none ? svg_mark(curve, centre, mark.standing != Standing::converged)
                                  : svg_cross(curve, centre)) +
           "</g>\n";
  }

  // Small boxes along a line.
  void keep_clear(Place from, Place to) {
    const int steps = 1 + static_cast<int>(std::hypot(to.x - from.x, to.y - from.y) / 6);
    for (int i = 0; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      const Place at{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
      drawn_.push_back({at.x - 3, at.y - 3, at.x + 3, at.y + 3});
    }
  }

  static const char* colour(std::size_t curve) { return figure_colours.at(curve % figure_colours.size()); }

  static constexpr const char* ink = "stroke=\"#000000\"";
  const Figure& figure_;
  Legend legend_;
  Box frame_;
  Axes axes_;
  std::vector<Box> drawn_;
};

}  // namespace

FigureLayout figure_layout(const Figure& figure) { return Drawing(figure).layout(); }

std::string svg_figure(const Figure& figure) { return Drawing(figure).svg(); }

}  // namespace peclet::runner
