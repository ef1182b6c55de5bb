#include "runner/text/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "runner/text/chart_axis.h"
#include "runner/text/html.h"

namespace peclet::runner {
namespace {

constexpr double radius = 4.5;  // of marks

// Where the frame is, and how many numbers fit below it.
struct Canvas {
  const char* style;
  double width, height;
  std::size_t most_ticks;
  double left = 72, top = 12;
  double right() const { return width - 14; }
  double bottom() const { return height - 52; }
};

Canvas canvas_of(ChartForm form) {
  return form == ChartForm::wide ? Canvas{"for-wide", 720, 400, 9} : Canvas{"for-narrow", 360, 300, 5};
}

const char* style_of(ChartPoint::Kind kind) { return kind == ChartPoint::Kind::decided ? "solid" : "hollow"; }

// From the smallest to the largest number of one direction.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", style,
                     x1, y1, x2, y2);
}

// Circle, square, diamond and triangle in turn.
std::string mark(std::size_t series, double x, double y, ChartPoint::Kind kind) {
  const char* const style = style_of(kind);
  const double r = radius;
  switch (series % 4) {
    case 0:
      return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n", style, x, y, r);
    case 1:
      return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}h{}v{}h-{}z\"/>\n", style, x - r, y - r, 2 * r,
                         2 * r, 2 * r);
    case 2:
      return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{} {}l-{} {}l-{} -{}z\"/>\n", style, x,
                         y - 1.3 * r, 1.3 * r, 1.3 * r, 1.3 * r, 1.3 * r, 1.3 * r, 1.3 * r);
    default:
      return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{} {}h-{}z\"/>\n", style, x, y - 1.2 * r,
                         1.2 * r, 2.2 * r, 2.4 * r);
  }
}

std::string frame(const Chart& chart, const Canvas& canvas, const ChartAxis& x, const ChartAxis& y) {
  const double left = canvas.left, right = canvas.right(), top = canvas.top, bottom = canvas.bottom();
  std::string text;
  for (const ChartAxis::Tick& tick : x.ticks()) {
    const double place = x.place(tick.value);
    text += line(place, top, place, bottom, "grid");
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", place,
                        bottom + 18, tick.text);
  }
  for (const ChartAxis::Tick& tick : y.ticks()) {
    const double place = y.place(tick.value);
    text += line(left, place, right, place, "grid");
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 7,
                        place + 4.5, tick.text);
  }
  text += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top,
                      right - left, bottom - top);
  const double middle = (left + right) / 2, centre = (top + bottom) / 2;
  text += fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                      middle, canvas.height - 10, escaped(chart.x_title));
  text += fmt::format(
      "<text class=\"title\" transform=\"translate(16 {:.1f}) rotate(-90)\" "
      "text-anchor=\"middle\">{}</text>\n",
      centre, escaped(chart.y_title));
  return text;
}

std::string error_bar(const ChartPoint& point, const ChartAxis& x, const ChartAxis& y) {
  constexpr double cap = 4;
  const double place = x.place(point.x);
  const double from = y.place(point.y - point.error), to = y.place(point.y + point.error);
  return line(place, from, place, to, "bar") + line(place - cap, from, place + cap, from, "bar") +
         line(place - cap, to, place + cap, to, "bar");
}

std::string drawn(const ChartSeries& series, std::size_t index, const ChartAxis& x, const ChartAxis& y) {
  std::string text = fmt::format("<g class=\"series-{}\">\n", index);
  std::string path;
  for (const ChartPoint& point : series.points) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.place(point.x), y.place(point.y));
  }
  if (series.points.size() > 1) text += "<path class=\"guide\" d=\"" + path + "\"/>\n";
  for (const ChartPoint& point : series.points) {
    const bool provisional = point.kind == ChartPoint::Kind::provisional;
    text += std::string(provisional ? "<g class=\"provisional\">" : "<g>") + "<title>" +
            escaped(point.title) + "</title>\n" + error_bar(point, x, y) +
            mark(index, x.place(point.x), y.place(point.y), point.kind) + "</g>\n";
  }
  return text + "</g>\n";
}

}  // namespace

std::string svg(const Chart& chart, ChartForm form) {
  Range across, up;
  std::vector<double> places, ends;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      across.include(point.x);
      places.push_back(point.x);
      for (const double end : {point.y - point.error, point.y + point.error}) {
        up.include(end);
        ends.push_back(end);
      }
    }
  }
  const Canvas canvas = canvas_of(form);
  const ChartAxis x(fitting_scale(places), across.low, across.high, canvas.left, canvas.right(),
                    canvas.most_ticks);
  const ChartAxis y(fitting_scale(ends), up.low, up.high, canvas.bottom(), canvas.top);
  std::string text =
      fmt::format("<svg class=\"{}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} over {}\">\n",
                  canvas.style, canvas.width, canvas.height, escaped(chart.y_title), escaped(chart.x_title));
  text += frame(chart, canvas, x, y);
  for (std::size_t i = 0; i < chart.series.size(); ++i) text += drawn(chart.series[i], i, x, y);
  return text + "</svg>\n";
}

std::string svg_mark(std::size_t series, ChartPoint::Kind kind) {
  return fmt::format("<svg class=\"mark series-{}\" viewBox=\"0 0 14 14\">{}</svg>", series,
                     mark(series, 7, 7, kind));
}

}  // namespace peclet::runner
