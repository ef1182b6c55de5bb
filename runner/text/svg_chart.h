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
  enum class Kind { decided, undecided, provisional };
  Kind kind = Kind::decided;  // full mark; hollow; hollow and faint, with a bar of dashes
  std::string title;          // shown by browsers over the mark
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

// Text keeps its size where a chart is shrunk to a telephone only if that is drawn for it: a page has both
// forms, and shows one.
enum class ChartForm { wide, narrow };

// Requires finite numbers, one point at least, and no more than `most_series`.
std::string svg(const Chart& chart, ChartForm form = ChartForm::wide);

// The mark of the i-th series alone, as small as text.
std::string svg_mark(std::size_t series, ChartPoint::Kind kind);

}  // namespace peclet::runner
