#include "engine/flow/segments.h"

#include <fmt/format.h>

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

// Tolerates rounding at the end of a segment.
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

namespace {

Segment read_segment(const SceneDocument& scene, const std::string& pointer) {
  const Json& keys = scene.at(pointer);
  Segment segment;
  segment.first_rate = keys.at("shear_rate").get<double>();
  segment.last_rate = keys.value("final_rate", segment.first_rate);
  if (keys.contains("strain") == keys.contains("time")) {
    scene.refuse(pointer, "must have either strain or time, how long it lasts; only the last one has none");
  }
  if (keys.contains("time")) {
    segment.time = keys.at("time").get<double>();
    return segment;
  }
  if (segment.first_rate == 0 && segment.last_rate == 0) {
    scene.refuse(pointer + "/strain", "must be a time instead where the shear rate is 0");
  }
  segment.time = time_of_segment(segment.first_rate, segment.last_rate, keys.at("strain").get<double>());
  return segment;
}

std::shared_ptr<const Deformation> read_segments(const FlowSource& source) {
  const SceneDocument& scene = source.scene;
  const std::size_t last = scene.at("/flow/segments").size() - 1;
  std::vector<Segment> all;
  for (std::size_t k = 0; k < last; ++k)
    all.push_back(read_segment(scene, fmt::format("/flow/segments/{}", k)));
  const std::string pointer = fmt::format("/flow/segments/{}", last);
  for (const char* key : {"strain", "time", "final_rate"}) {
    if (scene.at(pointer).contains(key)) {
      scene.refuse(pointer + '/' + key, "must be left out of the last segment, which goes on");
    }
  }
  return std::make_shared<Segments>(all, scene.at(pointer).at("shear_rate").get<double>());
}

constexpr const char* segment_keys = R"(
/flow/segments? | array of 1 to 64 | Shear in the place of shear_rate whose rate changes: a list of segments
    in time. Reversals, stops and ramps are such lists.
/flow/segments/* | object | One segment; the last one goes on and says its rate alone.
/flow/segments/*/shear_rate | number; in 1 / time | Shear rate, of either sign.
/flow/segments/*/final_rate? | number; in 1 / time | Shear rate at its end, to which it changes linearly; that
    of its beginning unless given.
/flow/segments/*/strain? | number > 0 | Strain that it makes, summed over both directions.
/flow/segments/*/time? | number > 0; in time | Time that it takes, in the place of strain.
)";

}  // namespace

FlowKind segments_flow() { return {.key = "/flow/segments", .keys = segment_keys, .read = read_segments}; }

}  // namespace peclet::engine
