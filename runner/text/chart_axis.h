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

  enum class Scale { linear, logarithmic };

  // From the smallest number `low` to the largest `high`, with a margin on both sides, drawn from `begin` to
  // `end`. Requires positive numbers where it is logarithmic, and three ticks at least.
  ChartAxis(Scale scale, double low, double high, double begin, double end, std::size_t most_ticks = 9);

  double place(double value) const;
  // Round numbers within the axis, in order, two at least: 1, 2 or 5 times a power of ten apart. On a
  // logarithmic one powers of ten, with twice and five times these, or all multiples, where there would be
  // too few.
  std::vector<Tick> ticks() const;

 private:
  std::vector<Tick> linear_ticks() const;
  std::vector<Tick> logarithmic_ticks() const;
  // Powers of ten, every `stride`-th, times each of `multiples`.
  std::vector<Tick> powers(int stride, const std::vector<int>& multiples) const;

  bool logarithmic_;
  std::size_t most_ticks_;
  double low_, high_;  // of what is drawn: the logarithms to base ten on a logarithmic axis
  double begin_, end_;
};

// Logarithmic for positive numbers that lie more evenly on such an axis, over a factor of five or more: a
// viscosity that diverges, Péclet numbers of 1, 10, 100; not volume fractions of 0.1, 0.2 ... 0.6.
ChartAxis::Scale fitting_scale(std::vector<double> numbers);

}  // namespace peclet::runner
