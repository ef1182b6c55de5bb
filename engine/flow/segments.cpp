#include "engine/flow/segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace peclet::engine {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double slope(const Segment& segment) {
  return std::isinf(segment.time) ? 0 : (segment.last_rate - segment.first_rate) / segment.time;
}

// After this time in it.
double strain_after(const Segment& segment, double time) {
  return (segment.first_rate + 0.5 * slope(segment) * time) * time;
}

}  // namespace

double time_of_segment(double first_rate, double last_rate, double strain) {
  const double first = std::abs(first_rate), last = std::abs(last_rate);
  const bool turns = first_rate * last_rate < 0;
  const double mean = turns ? 0.5 * (first * first + last * last) / (first + last) : 0.5 * (first + last);
  return strain / mean;
}

Segments::Segments(const std::vector<Segment>& segments, double rate) {
  double begin = 0, strain = 0, way = 0;
  const auto add = [&](const Segment& segment) {
    if (!(segment.time > 0)) return;
    parts_.push_back({segment, begin, strain, way});
    begin += segment.time;
    strain += segment.strain();
    way += std::abs(segment.strain());
  };
  for (const Segment& segment : segments) {
    const auto [first, last, time] = segment;
    if (first * last < 0) {
      const double before = time * first / (first - last);
      add({first, 0, before});
      add({0, last, time - before});
    } else {
      add(segment);
    }
  }
  parts_.push_back({{rate, rate, infinite}, begin, strain, way});
}

const Segments::Part& Segments::part_at(double time) const {
  const auto after = [](double t, const Part& part) { return t < part.begin; };
  const auto next = std::upper_bound(parts_.begin() + 1, parts_.end(), time, after);
  return *(next - 1);
}

double Segments::rate_at(double time) const {
  const Part& part = part_at(time);
  return part.segment.first_rate + slope(part.segment) * (time - part.begin);
}

double Segments::way_at(double time) const {
  const Part& part = part_at(time);
  return part.way + std::abs(strain_after(part.segment, time - part.begin));
}

Matrix3 Segments::velocity_gradient(double time) const { return simple_shear(rate_at(time)); }

Matrix3 Segments::displacement_gradient(double time) const {
  const Part& part = part_at(time);
  return simple_shear(part.strain + strain_after(part.segment, time - part.begin));
}

double Segments::largest_rate() const {
  double largest = 0;
  for (const Part& part : parts_) {
    largest = std::max({largest, std::abs(part.segment.first_rate), std::abs(part.segment.last_rate)});
  }
  return largest;
}

bool Segments::jumps_between(double from, double to) const {
  for (std::size_t k = 1; k < parts_.size(); ++k) {
    const bool jumps = parts_[k].segment.first_rate != parts_[k - 1].segment.last_rate;
    if (jumps && parts_[k].begin >= from && parts_[k].begin < to) return true;
  }
  return false;
}

// Whoever measures from the end of a segment may come by a rounding error too early.
Matrix3 Segments::steady_gradient(double from) const {
  const Part& last = parts_.back();
  return from >= last.begin * (1 - 1e-9) ? simple_shear(last.segment.first_rate) : Matrix3{};
}

double Segments::time_of(double strain, double from) const {
  if (std::isinf(strain)) return strain;
  const double way = way_at(from) + strain;
  const auto before = [](const Part& part, double w) { return part.way < w; };
  const Part& part = *(std::lower_bound(parts_.begin() + 1, parts_.end(), way, before) - 1);
  const double rest = way - part.way, first = std::abs(part.segment.first_rate);
  if (rest == 0) return part.begin - from;
  // first t + slope t^2 / 2 = rest, in a form that has no difference of near numbers for a rising rate.
  const double rise = slope(part.segment) * (part.segment.first_rate + part.segment.last_rate < 0 ? -1 : 1);
  const double root = first + std::sqrt(std::max(first * first + 2 * rise * rest, 0.0));
  return root > 0 ? part.begin + 2 * rest / root - from : infinite;
}

double Segments::strain_between(double timestep, std::uint64_t from, std::uint64_t to) const {
  return way_at(timestep * static_cast<double>(to)) - way_at(timestep * static_cast<double>(from));
}

}  // namespace peclet::engine
