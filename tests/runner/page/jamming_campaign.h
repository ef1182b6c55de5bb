// Campaigns over the volume fraction, with viscosities that follow a law.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "runner/page/jamming.h"
#include "tests/contract/python_of_debian.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {

struct TrueLaw {
  double fraction = 0.65, exponent = 1.6, prefactor = 1.4;
  double at(double phi) const { return prefactor * std::pow(1 - phi / fraction, -exponent); }
};

inline Json jamming_document(const std::vector<double>& fractions, const Json& before = Json::array()) {
  Json sweep = before;
  sweep.push_back({{"set", "/volume_fraction"}, {"values", fractions}});
  return {{"name", "jam"},
          {"scene", {{"contact", {{"friction", 0}}}}},
          {"sweep", sweep},
          {"target", {{"relative_tolerance", 0.05}}},
          {"realisations", {{"minimum", 8}, {"maximum", 8}}}};
}

class JammingCampaign {
 public:
  explicit JammingCampaign(const Json& document)
      : campaign_(parse_campaign(document, "jam.json")), stored_(campaign_) {}

  // Stores eight seeds whose mean is exactly `viscosity`, with the relative standard deviation `relative` (n
  // - 1), this mean overlap, and a largest overlap fifty times as large.
  void complete(int point, double viscosity, double relative = 0.01, double overlap = 1e-4) {
    for (int seed = 0; seed < 8; ++seed) {
      const double away = (seed % 2 == 0 ? 1 : -1) * relative * std::sqrt(7.0 / 8);
      constexpr double control = 0.25;  // of plain_result(), which an estimate adds
      stored_.complete_with(point, seed, viscosity * (1 + away) - control, [&](Json& result) {
        result["mean"]["mean_overlap"] = overlap;
        result["largest_overlap"] = 50 * overlap;
      });
    }
  }
  void jam(int point, int seeds = 8, const std::string& cause = "overlap") {
    for (int seed = 0; seed < seeds; ++seed) stored_.blow_up(point, seed, cause);
  }

  StoredCampaign& stored() { return stored_; }
  Json curves(const CurveChoice& choice = {}) { return read_curves(stored_.database(), choice); }
  Json points() { return curves()["curves"].at(0)["points"]; }

 private:
  Campaign campaign_;
  StoredCampaign stored_;
};

}  // namespace peclet::runner
