#include "engine/flow/segments.h"

#include <fmt/format.h>

#include <cmath>

namespace peclet::engine {
namespace {

Segment read_segment(const SceneDocument& scene, const std::string& pointer) {
  const Json& keys = scene.at(pointer);
  Segment segment;
  segment.first_rate = keys.at("shear_rate").get<double>();
  segment.last_rate = keys.value("final_rate", segment.first_rate);
  if (keys.contains("strain") == keys.contains("time")) {
    scene.refuse(pointer, "must have either strain or time; only the last segment has neither");
  }
  if (keys.contains("time")) {
    segment.time = keys.at("time").get<double>();
    return segment;
  }
  if (segment.first_rate == 0 && segment.last_rate == 0) {
    scene.refuse(pointer + "/strain", "must be left out where the shear rate is 0; give time instead");
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
      scene.refuse(pointer + '/' + key, "must be left out of the last segment, which does not end");
    }
  }
  return std::make_shared<Segments>(all, scene.at(pointer).at("shear_rate").get<double>());
}

constexpr const char* segment_keys = R"(
/flow/segments? | array of 1 to 64 | Shear whose rate changes, in place of shear_rate: a list of segments in
    time, for reversals, stops and ramps.
/flow/segments/* | object | The last segment does not end and has a shear_rate only.
/flow/segments/*/shear_rate | number; in 1 / time | Shear rate, of either sign.
/flow/segments/*/final_rate? | number; in 1 / time | Shear rate at the end of the segment, to which the rate
    changes linearly; shear_rate unless given.
/flow/segments/*/strain? | number > 0 | Strain of the segment, summed over both directions.
/flow/segments/*/time? | number > 0; in time | Duration of the segment, in place of strain.
)";

}  // namespace

double time_of_segment(double first_rate, double last_rate, double strain) {
  const double first = std::abs(first_rate), last = std::abs(last_rate);
  const bool turns = first_rate * last_rate < 0;
  const double mean = turns ? 0.5 * (first * first + last * last) / (first + last) : 0.5 * (first + last);
  return strain / mean;
}

FlowKind segments_flow() { return {.key = "/flow/segments", .keys = segment_keys, .read = read_segments}; }

}  // namespace peclet::engine
