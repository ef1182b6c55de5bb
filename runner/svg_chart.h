// A chart of numbers with error bars, as SVG to be put into an HTML page.
//
// Colours are the page's: the classes series-0 .. series-7 have a colour each, frame and grid theirs. Series
// also differ in their marks, for prints without colour.
#pragma once

#include <string>
#include <vector>

namespace peclet::runner {

struct ChartPoint {
  double x = 0, y = 0;
  double error = 0;  // half-length of its bar
  bool solid = true;
  std::string title;  // shown by browsers over the mark
};

struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points;  // by x
};

struct Chart {
  std::string x_title, y_title;
  std::vector<ChartSeries> series;
};

constexpr std::size_t most_series = 8;

// Requires finite numbers, one point at least, and no more than `most_series`.
std::string svg(const Chart& chart);

// The mark of the i-th series alone, as small as text.
std::string svg_mark(std::size_t series, bool solid);

}  // namespace peclet::runner
