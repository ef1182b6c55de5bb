// Segments is simple shear whose rate is constant or changes linearly in each of a list of segments in time.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

struct Segment {
  double first_rate = 0, last_rate = 0;  // [1/time], of either sign
  double time = 0;                       // duration

  double strain() const { return 0.5 * (first_rate + last_rate) * time; }
  double slope() const { return std::isinf(time) ? 0 : (last_rate - first_rate) / time; }
  // Returns the net strain at the time t after the beginning of the segment.
  double strain_after(double t) const { return (first_rate + 0.5 * slope() * t) * t; }
};

// Returns the duration [time] in which a segment makes this strain, summed over both directions.
double time_of_segment(double first_rate, double last_rate, double strain);

class Segments final : public Deformation {
 public:
  // `rate` is the shear rate after the last segment [1/time].
  Segments(const std::vector<Segment>& segments, double rate) {
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
    parts_.push_back({{rate, rate, std::numeric_limits<double>::infinity()}, begin, strain, way});
  }

  Matrix3 velocity_gradient(double time) const override { return simple_shear(rate_at(time)); }
  Matrix3 displacement_gradient(double time) const override {
    const Part& part = part_at(time);
    return simple_shear(part.strain + part.segment.strain_after(time - part.begin));
  }
  double largest_rate() const override {
    double largest = 0;
    for (const Part& part : parts_) {
      largest = std::max({largest, std::abs(part.segment.first_rate), std::abs(part.segment.last_rate)});
    }
    return largest;
  }
  bool jumps_between(double from, double to) const override {
    for (std::size_t k = 1; k < parts_.size(); ++k) {
      const bool jumps = parts_[k].segment.first_rate != parts_[k - 1].segment.last_rate;
      if (jumps && parts_[k].begin >= from && parts_[k].begin < to) return true;
    }
    return false;
  }
  // Tolerates rounding at the end of the last segment that ends.
  Matrix3 steady_gradient(double from) const override {
    const Part& last = parts_.back();
    return from >= last.begin * (1 - 1e-9) ? simple_shear(last.segment.first_rate) : Matrix3{};
  }
  double time_of(double strain, double from) const override {
    if (std::isinf(strain)) return strain;
    const double way = way_at(from) + strain;
    const auto before = [](const Part& part, double w) { return part.way < w; };
    const Part& part = *(std::lower_bound(parts_.begin() + 1, parts_.end(), way, before) - 1);
    const double rest = way - part.way, first = std::abs(part.segment.first_rate);
    if (rest == 0) return part.begin - from;
    // Solves first t + slope t^2 / 2 = rest, without cancellation if the rate rises.
    const double rise =
        part.segment.slope() * (part.segment.first_rate + part.segment.last_rate < 0 ? -1 : 1);
    const double root = first + std::sqrt(std::max(first * first + 2 * rise * rest, 0.0));
    return root > 0 ? part.begin + 2 * rest / root - from : std::numeric_limits<double>::infinity();
  }
  double strain_between(double timestep, std::uint64_t from, std::uint64_t to) const override {
    return way_at(timestep * static_cast<double>(to)) - way_at(timestep * static_cast<double>(from));
  }

 private:
  // A segment whose rate keeps its sign, with time and strain at its beginning.
  struct Part {
    Segment segment;
    double begin = 0, strain = 0, way = 0;  // `way` is the strain summed over both directions
  };
  const Part& part_at(double time) const {
    const auto after = [](double t, const Part& part) { return t < part.begin; };
    const auto next = std::upper_bound(parts_.begin() + 1, parts_.end(), time, after);
    return *(next - 1);
  }
  double rate_at(double time) const {
    const Part& part = part_at(time);
    return part.segment.first_rate + part.segment.slope() * (time - part.begin);
  }
  double way_at(double time) const {
    const Part& part = part_at(time);
    return part.way + std::abs(part.segment.strain_after(time - part.begin));
  }

  std::vector<Part> parts_;  // the last one has no end
};

FlowKind segments_flow();

}  // namespace peclet::engine
