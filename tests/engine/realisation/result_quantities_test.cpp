// The list of quantities in a result, compared with the values.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/realisation/result.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Returns the number of entries along each axis of a value.
std::vector<std::size_t> shape_of(const Json& value) {
  std::vector<std::size_t> shape;
  for (const Json* list = &value; list->is_array(); list = &list->front()) shape.push_back(list->size());
  return shape;
}

const Json& at_path(const Json& document, const std::string& name) {
  return document.at(Json::json_pointer('/' + name));
}

TEST(Result, DescribesItsQuantitiesAsTheyAre) {
  const Json sheared = result_of(
      {{"observables",
        {"stress", "mean_squared_displacement", "pair_distribution", "contact_network", "profiles"}},
       {"pair_distribution", {{"range", 3}}}});
  EXPECT_TRUE(sheared.at("quantities").contains("profiles/velocity"));
  const Json at_rest = result_of(
      {{"flow", {{"shear_rate", 0}}}, {"observables", {"mean_squared_displacement", "stress_correlation"}}});
  const Json responding = result_of({{"flow", {{"shear_rate", 0}}},
                                     {"contact",
                                      {{"friction", nullptr},
                                       {"normal_damping", nullptr},
                                       {"rolling_stiffness", nullptr},
                                       {"rolling_friction", nullptr}}},
                                     {"duration", {{"production", {{"time", 1.2}}}}},
                                     {"observables", {"linear_response"}}});
  EXPECT_TRUE(responding.at("quantities").contains("zero_shear_viscosity"));
  for (const Json& result : {sheared, at_rest, responding}) {
    for (const auto& [name, quantity] : result.at("quantities").items()) {
      const Json& value = at_path(result.at("mean"), name);
      const bool is_ratio = quantity.at("estimator") == "ratio";
      std::vector<std::size_t> shape;
      for (const Json& axis : quantity.value("axes", Json::array()))
        shape.push_back(axis.at("values").size());
      EXPECT_EQ(shape_of(is_ratio ? value.at(quantity.at("numerator")) : value), shape) << name;
      EXPECT_FALSE(quantity.at("symbol").get<std::string>().empty()) << name;
      EXPECT_FALSE(quantity.at("unit").get<std::string>().empty()) << name;
      if (shape.empty() && result.at("blocks").contains(Json::json_pointer('/' + name))) {
        EXPECT_GE(result.at("inefficiencies").at(name).get<double>(), 1) << name;
      }
    }
  }
  EXPECT_EQ(sheared.at("quantities").at("relative_viscosity"),
            (Json{{"symbol", "η_r"}, {"unit", "1"}, {"estimator", "mean"}}));
  EXPECT_EQ(sheared.at("quantities").at("pressure").at("unit"), "η γ̇");
  EXPECT_EQ(at_rest.at("quantities").at("pressure").at("unit"), "stress");
  EXPECT_FALSE(at_rest.at("quantities").contains("relative_viscosity"));
}

TEST(Result, AxesAreThoseOfTheLags) {
  const Json result = result_of(
      {{"flow", {{"shear_rate", 0}}}, {"observables", {"mean_squared_displacement", "stress_correlation"}}});
  for (const char* name : {"mean_squared_displacement", "stress_correlation"}) {
    const std::string vector = std::string(name) + (name[0] == 'm' ? "/all/y" : "/modulus");
    EXPECT_EQ(result.at("quantities").at(vector).at("axes")[0].at("values"),
              result.at("mean").at(name).at("time"))
        << name;
  }
}

TEST(Result, AxesOfProfilesByRadiusAreRadiiAndHeights) {
  const Json result = result_of({{"observables", {"profiles"}}, {"profiles", {{"bins", 4}}}});
  const Json axes = result.at("quantities").at("profiles/volume_fraction_by_radius").at("axes");
  EXPECT_EQ(axes[0], (Json{{"name", "radius"}, {"unit", "length"}, {"values", {1.0, 1.4}}}));
  EXPECT_EQ(axes[1], result.at("quantities").at("profiles/volume_fraction").at("axes")[0]);
  EXPECT_EQ(result.at("mean").at("profiles").at("volume_fraction_by_radius").size(), 2u);
}

}  // namespace
}  // namespace peclet::engine
