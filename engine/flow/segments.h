// Simple shear whose rate is constant or changes linearly in each of a list of segments in time.
#pragma once

#include <vector>

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

struct Segment {
  double first_rate = 0, last_rate = 0;  // either sign
  double time = 0;                       // its duration

  double strain() const { return 0.5 * (first_rate + last_rate) * time; }
};

// Returns the duration of a segment of these rates and this strain, summed over both directions.
double time_of_segment(double first_rate, double last_rate, double strain);

class Segments final : public Deformation {
 public:
  // `rate`: after the last segment.
  Segments(const std::vector<Segment>& segments, double rate);

  Matrix3 velocity_gradient(double time) const override;
  Matrix3 displacement_gradient(double time) const override;
  double largest_rate() const override;
  bool jumps_between(double from, double to) const override;
  Matrix3 steady_gradient(double from) const override;
  double time_of(double strain, double from) const override;
  double strain_between(double timestep, std::uint64_t from, std::uint64_t to) const override;

 private:
  // A segment whose rate keeps its sign, and the time and strain at its beginning.
  struct Part {
    Segment segment;
    double begin = 0, strain = 0, way = 0;  // `way`: the strain summed over both directions
  };
  const Part& part_at(double time) const;
  double rate_at(double time) const;
  double way_at(double time) const;

  std::vector<Part> parts_;  // the last one has no end
};

FlowKind segments_flow();

}  // namespace peclet::engine
