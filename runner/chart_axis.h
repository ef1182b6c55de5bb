// An axis of a chart: where a number lies on it, and which numbers are written beside it.
#pragma once

#include <string>
#include <vector>

namespace peclet::runner {

class ChartAxis {
 public:
  struct Tick {
    double value;
    std::string text;
  };

  // From the smallest number `low` to the largest `high`, with a margin on both sides, drawn from `begin` to
  // `end`. Logarithmic when the numbers are positive and span more than a factor of 20.
  ChartAxis(double low, double high, double begin, double end);

  bool is_logarithmic() const { return logarithmic_; }
  double place(double value) const;
  // Three to nine round numbers within the axis, in order: 1, 2 or 5 times a power of ten apart. On a
  // logarithmic one powers of ten, and twice and five times these where there would be too few.
  std::vector<Tick> ticks() const;

 private:
  std::vector<Tick> linear_ticks() const;
  std::vector<Tick> logarithmic_ticks() const;
  // Powers of ten, every `stride`-th, times each of `multiples`.
  std::vector<Tick> powers(int stride, const std::vector<int>& multiples) const;

  bool logarithmic_;
  double low_, high_;  // of what is drawn: the logarithms to base ten on a logarithmic axis
  double begin_, end_;
};

}  // namespace peclet::runner
