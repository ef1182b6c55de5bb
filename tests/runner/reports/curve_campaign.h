// Campaigns with a curve along the Péclet number, for tests of what is said of them.
#pragma once

#include <random>

#include "tests/runner/stored_campaign.h"

namespace peclet::runner {

inline Campaign curve_campaign() {
  return parse_campaign(Json::parse(R"({
  "name": "curve", "scene": {},
  "sweep": [{"set": ["/peclet", "/window"],
             "values": [[0.1, 9], [1, 8], [10, 7], [100, 6], [1000, 5], [10000000, 4]]}],
  "target": {"curve": {"over": "/peclet", "relative_tolerance": 0.05}},
  "realisations": {"minimum": 8, "maximum": 100}})"),
                        "curve.json");
}

// Seeds of normal values about `mean` with a spread of 10 %, the same for the same point.
inline void complete(StoredCampaign& campaign, int point, double mean, int seeds) {
  std::mt19937_64 random(static_cast<unsigned>(point) + 1);
  std::normal_distribution<double> normal;
  for (int seed = 0; seed < seeds; ++seed) campaign.complete(point, seed, mean * (1 + 0.1 * normal(random)));
}

// All six points are 10, but for the fourth one.
inline StoredCampaign& decided(StoredCampaign& campaign, double fourth = 10) {
  for (int point = 0; point < 6; ++point)
    complete(campaign, point, point == 3 ? fourth : 10, point == 5 ? 60 : 25);
  return campaign;
}

}  // namespace peclet::runner
