// Figures of quantities with an axis of their own, of several quantities, of some points, and of scaled axes.
#include <gtest/gtest.h>

#include <cmath>

#include "contract/errors.h"
#include "runner/page/figure.h"
#include "runner/store/point_store.h"
#include "tests/contract/refusal.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

Json described(const char* unit, const Json& axes = Json::array()) {
  return {{"symbol", "s"}, {"unit", unit}, {"estimator", "mean"}, {"axes", axes}};
}
Json axis(const char* name, const char* unit, const Json& values) {
  return {{"name", name}, {"unit", unit}, {"values", values}};
}

// Adds curves whose values follow from `base`, and numbers that follow from the scene.
void add_curves(Json& result, double base) {
  const Json strain = axis("strain", "1", {0.5, 1.5, 2.5}),
             frequency = axis("frequency", "1 / time", {2, 20});
  const Json component = axis("component", "1", {"xx", "xy"}), y = axis("y", "length", {1, 2, 3});
  result["quantities"] = {{"relative_viscosity", described("1")},
                          {"pressure", described("η γ̇")},
                          {"transient/shear_stress", described("η γ̇", Json::array({strain}))},
                          {"moduli/storage", described("stress", Json::array({frequency}))},
                          {"moduli/loss", described("stress", Json::array({frequency}))},
                          {"profiles/stress", described("stress", Json::array({component, y}))}};
  Json& mean = result["mean"];
  mean["transient"]["shear_stress"] = {base, 2 * base, nullptr};
  mean["moduli"] = {{"storage", {base, 3 * base}}, {"loss", {4 * base, 5 * base}}};
  mean["profiles"]["stress"] = {{base, base + 1, base + 2}, {10 * base, 20 * base, 30 * base}};
  result["derived"] = {{"brownian_time", 5.0},
                       {"viscous_stress", 0.5},
                       {"thermal_stress", 0.25},
                       {"critical_stress", nullptr},
                       {"peclet", 2 * base}};
}

class CurveFigure : public testing::Test {
 protected:
  CurveFigure() {
    const Json derived = {{{"name", "brownian_time"}, {"symbol", "τ_B"}, {"unit", "time"}},
                          {{"name", "viscous_stress"}, {"symbol", "η γ̇"}, {"unit", "stress"}},
                          {{"name", "thermal_stress"}, {"symbol", "k_B T / a^3"}, {"unit", "stress"}},
                          {{"name", "critical_stress"}, {"symbol", "F_CL / a^2"}, {"unit", "stress"}},
                          {{"name", "peclet"}, {"words", "Péclet number"}, {"symbol", "Pe"}, {"unit", "1"}}};
    keep_vocabulary(campaign_.database(), Vocabulary(Json{{"derived", derived}}));
  }
  void complete(int point, double value) {
    const double away[] = {-1, 0, 1, 0};
    for (int seed = 0; seed < 4; ++seed) {
      campaign_.complete_with(point, seed, 10 + away[seed],
                              [&](Json& result) { add_curves(result, value + away[seed]); });
    }
  }
  Json figure(const FigureChoice& choice) { return figure_data(campaign_.database(), choice); }
  std::string refusal(const FigureChoice& choice) {
    return refusal_by([&] { figure(choice); });
  }

  StoredCampaign campaign_{3, 4, 4};
};

constexpr double t_of_3 = 3.18244630528;  // Student's t at 95 %, 3 degrees of freedom

TEST_F(CurveFigure, HasTheMeanAndItsIntervalAtEachPlace) {
  complete(0, 10);
  complete(1, 20);
  const Json drawn = figure({.quantities = {"/transient/shear_stress"}});
  EXPECT_EQ(drawn["axis"], Json({{"name", "strain"}, {"unit", "1"}, {"scale", ""}}));
  ASSERT_EQ(drawn["points"].size(), 3U);
  const Json& curve = drawn["points"][1];
  EXPECT_EQ(curve["x"], Json({0.5, 1.5, 2.5}));
  EXPECT_EQ(curve["mean"], Json({20, 40, nullptr}));
  const double error = std::sqrt(2.0 / 3) / 2;  // of -1, 0, 1, 0
  EXPECT_NEAR(curve["standard_error"][1].get<double>(), 2 * error, 1e-12);
  EXPECT_NEAR(curve["half_width"][1].get<double>(), t_of_3 * 2 * error, 1e-9);
  EXPECT_EQ(curve["count"], Json({4, 4, 0}));
  EXPECT_TRUE(drawn["points"][2]["x"].empty());
}

TEST_F(CurveFigure, HasTheSeedsOfTheLastStopTestAlone) {
  complete(0, 10);
  campaign_.complete_with(0, 4, 10, [](Json& result) { add_curves(result, 1000); });
  EXPECT_EQ(figure({.quantities = {"moduli/loss"}})["points"][0]["mean"], Json({40, 50}));
}

TEST_F(CurveFigure, RunsOverTheLastAxisAtAnElementOfTheOthers) {
  complete(0, 10);
  EXPECT_EQ(figure({.quantities = {"profiles/stress/xy"}})["points"][0]["mean"], Json({100, 200, 300}));
  EXPECT_EQ(figure({.quantities = {"profiles/stress/xx"}})["points"][0]["mean"], Json({10, 11, 12}));
  EXPECT_EQ(
      refusal({.quantities = {"profiles/stress"}}),
      "--quantity: profiles/stress: is a curve for each element: xx, xy; name one, as profiles/stress/xx");
}

TEST_F(CurveFigure, OfSeveralQuantitiesHasOneUnitAndOneAxis) {
  complete(0, 10);
  const Json drawn = figure({.quantities = {"moduli/storage", "moduli/loss"}});
  EXPECT_EQ(drawn["points"][0]["quantity"], "moduli/storage");
  EXPECT_EQ(drawn["points"][1]["quantity"], "moduli/loss");
  EXPECT_EQ(drawn["points"][1]["mean"], Json({40, 50}));
  EXPECT_EQ(refusal({.quantities = {"moduli/loss", "transient/shear_stress"}}),
            "--quantity: transient/shear_stress: has the unit η γ̇, and moduli/loss has stress: the "
            "quantities of one "
            "frame must have one unit");
  EXPECT_EQ(
      refusal({.quantities = {"moduli/loss", "profiles/stress/xy"}}),
      "--quantity: profiles/stress/xy: has the axis y, and moduli/loss has frequency: the quantities of one "
      "frame must have one axis");
  EXPECT_EQ(refusal({.quantities = {"pressure", "transient/shear_stress"}}),
            "--quantity: transient/shear_stress: has an axis, strain, and another quantity has none: they do "
            "not fit "
            "in one frame");
  EXPECT_EQ(refusal({.quantities = {"pressure", "pressure"}}), "--quantity: pressure: is given twice");
}

TEST_F(CurveFigure, RefusesWhatBelongsToNumbers) {
  complete(0, 10);
  EXPECT_EQ(refusal({.quantities = {"moduli/loss"}, .over = "point"}),
            "--over: point: must not be given: moduli/loss has an axis of its own, frequency");
  EXPECT_EQ(refusal({.quantities = {"moduli/loss"}, .tolerance = true}),
            "--band: moduli/loss: must not be given: moduli/loss has an axis of its own, frequency");
  EXPECT_EQ(refusal({.quantities = {"moduli/los"}}),
            "--quantity: moduli/los: must be a measured quantity; did you mean moduli/loss?");
}

TEST_F(CurveFigure, HasThePointsThatAreAskedFor) {
  for (int point = 0; point < 3; ++point) complete(point, 10.0 * point);
  const auto labels = [&](const std::vector<std::string>& where, const std::string& quantity) {
    std::vector<std::string> found;
    const Json drawn = figure({.quantities = {quantity}, .where = where});
    for (const Json& point : drawn["points"]) found.push_back(point["label"]);
    return found;
  };
  const std::vector<std::string> both{"point=0", "point=2"};
  for (const char* const quantity : {"pressure", "moduli/loss"}) {
    EXPECT_EQ(labels({"point=2", "/point=0"}, quantity), both);
    EXPECT_EQ(labels({"point=2.0"}, quantity), std::vector<std::string>{"point=2"});
  }
  EXPECT_EQ(refusal({.where = {"point=7"}}), "--where: point=7: must be a value of a point: 0, 1, 2");
  EXPECT_EQ(refusal({.where = {"point"}}), "--where: point: must be NAME=VALUE, such as peclet=10");
  EXPECT_EQ(refusal({.where = {"peclet=7"}}),
            "--where: peclet: must be the name of one swept parameter: /point");
}

TEST_F(CurveFigure, OfAJammedPointHasNoNumbersOfThoseThatHappenedToFlow) {
  complete(0, 10);
  for (int seed = 0; seed < 3; ++seed) campaign_.blow_up(1, seed, "packing");
  campaign_.complete_with(1, 3, 11, [](Json& result) { add_curves(result, 1e8); });
  const Json point = figure({.quantities = {"moduli/loss"}})["points"][1];
  EXPECT_EQ(point["jammed"], true);
  EXPECT_EQ(point["mean"], Json({nullptr, nullptr}));
}

TEST_F(CurveFigure, IsScaledByANumberOrByOneThatFollowsFromTheScene) {
  complete(0, 10);
  const Json drawn =
      figure({.quantities = {"moduli/loss"}, .scale_x = "brownian_time", .scale_y = "thermal_stress"});
  EXPECT_EQ(drawn["axis"], Json({{"name", "frequency"}, {"unit", "1"}, {"scale", " τ_B"}}));
  EXPECT_EQ(drawn["quantities"][0]["scale"], " / (k_B T / a^3)");
  EXPECT_EQ(drawn["quantities"][0]["unit"], "1");
  const Json& curve = drawn["points"][0];
  EXPECT_EQ(curve["x"], Json({10, 100}));      // times 5
  EXPECT_EQ(curve["mean"], Json({160, 200}));  // over 0.25
  const double error = 5 * std::sqrt(2.0 / 3) / 2 / 0.25;
  EXPECT_NEAR(curve["standard_error"][1].get<double>(), error, 1e-9);
  EXPECT_NEAR(curve["half_width"][1].get<double>(), t_of_3 * error, 1e-6);
  const Json halved = figure({.quantities = {"moduli/loss"}, .scale_y = "2"});
  EXPECT_EQ(halved["points"][0]["mean"], Json({20, 25}));
  EXPECT_EQ(halved["quantities"][0]["scale"], " / 2");
  EXPECT_EQ(halved["quantities"][0]["unit"], "1");  // the number has that of the axis
}

// 20 η γ̇ with η γ̇ = 0.5, over 0.25.
TEST_F(CurveFigure, HasAUnitThatIsANumberOfTheScene) {
  complete(0, 10);
  const Json scaled = figure({.quantities = {"pressure"}, .scale_y = "thermal_stress"})["points"][0];
  const Json plain = figure({.quantities = {"pressure"}})["points"][0];
  for (const char* const number : {"mean", "standard_error", "half_width"}) {
    EXPECT_NEAR(scaled[number].get<double>(), plain[number].get<double>() * 0.5 / 0.25, 1e-12) << number;
  }
  EXPECT_EQ(refusal({.quantities = {"pressure"}, .scale_y = "viscous_stress"}),
            "--scale-y: viscous_stress: is the unit of these numbers already, η γ̇");
}

TEST_F(CurveFigure, StandsOverANumberThatFollowsFromTheScene) {
  for (int point = 0; point < 3; ++point) complete(point, 10.0 * (point + 1));
  const Json drawn = figure({.quantities = {"pressure"}, .over = "peclet"});
  EXPECT_EQ(drawn["over"], "peclet");
  EXPECT_EQ(drawn["parameters"].back()["words"], "Péclet number");
  EXPECT_EQ(drawn["points"][1]["settings"]["peclet"], 38);  // of the first seed
  const Json scaled = figure({.quantities = {"pressure"}, .over = "point", .scale_x = "4"});
  EXPECT_EQ(scaled["points"][2]["settings"]["/point"], 0.5);
  EXPECT_EQ(scaled["parameters"][0]["scale"], " / 4");
}

TEST_F(CurveFigure, StandsOverNoNumberThatIsTheSameAtAllPoints) {
  for (int point = 0; point < 3; ++point) complete(point, 10.0 * (point + 1));
  EXPECT_EQ(refusal({.quantities = {"pressure"}, .over = "brownian_time"}),
            "--over: brownian_time: is 5 at every point; --scale-x divides an axis by it");
}

TEST_F(CurveFigure, RefusesAScaleThatTheSceneLacks) {
  complete(0, 10);
  EXPECT_EQ(
      refusal({.quantities = {"moduli/loss"}, .scale_y = "critical_stress"}),
      "--scale-y: critical_stress: is not defined at point=0: its scene lacks what this number follows from; "
      "a number > 0 scales all points alike");
  EXPECT_EQ(refusal({.quantities = {"moduli/loss"}, .scale_y = "brownian_time"}),
            "--scale-y: brownian_time: has the unit time, and these numbers stress; must be a number > 0, or "
            "viscous_stress, thermal_stress");
  EXPECT_EQ(refusal({.quantities = {"moduli/loss"}, .scale_x = "brownian_tim"}),
            "--scale-x: brownian_tim: must be a number > 0, or brownian_time; did you mean brownian_time?");
  EXPECT_EQ(refusal({.quantities = {"moduli/loss"}, .scale_x = "-1"}),
            "--scale-x: -1: must be a number > 0, or brownian_time");
}

}  // namespace
}  // namespace peclet::runner
