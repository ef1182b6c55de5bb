// Where numbers lie along an axis, and which are written beside it. The page draws by the same rules
// (runner/page/assets/axis.js); tests/pages holds both to the same ticks.
#pragma once

#include <string>
#include <vector>

namespace peclet::runner {

// Whether positive numbers lie more evenly on a logarithmic axis, over a factor of five or more: a viscosity
// that diverges, Péclet numbers of 1, 10, 100; not volume fractions of 0.1, 0.2 ... 0.6.
bool is_logarithmic(std::vector<double> values);

// The numbers that are drawn, and what the axis makes of them.
struct AxisRange {
  double low = 0, high = 0;  // of a logarithmic axis both are positive
  bool log = false;
};

class Axis {
 public:
  // From `begin` to `end` of the drawing, with a margin on both sides of the range.
  Axis(const AxisRange& range, double begin, double end, std::size_t most_ticks);
  // Words that stand at 0, 1, 2 ... in the place of numbers.
  Axis(std::size_t words, double begin, double end);

  double place(double value) const;
  // The same, but not beyond the ends; what has no logarithm is at the beginning.
  double clamped(double value) const;
  // The numbers at both ends.
  double low() const;
  double high() const;
  bool is_log() const { return log_; }

  // A few round numbers within the axis, in their order; at least two.
  std::vector<double> ticks() const;
  // Multiples of powers of ten between the ticks of a logarithmic axis of two decades to ten; none elsewhere.
  std::vector<double> minor_ticks() const;

 private:
  std::vector<double> linear_ticks(double low, double high) const;
  std::vector<double> powers(int stride, const std::vector<int>& multiples) const;
  std::vector<double> logarithmic_ticks() const;

  bool log_ = false;
  double low_ = 0, high_ = 0;  // logarithms to the base 10 where the axis is logarithmic
  double begin_, end_;
  std::size_t most_ticks_, words_ = 0;
};

}  // namespace peclet::runner
