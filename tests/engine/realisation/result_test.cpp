// The numbers of a completed realisation, compared with independent sums, and their list of quantities.
#include "engine/realisation/result.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "engine/forces/configuration.h"
#include "tests/engine/every_image.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Returns the sum of the parts without the total.
std::vector<double> sum_of_parts(const Json& stress) {
  std::vector<double> sum(6);
  for (const auto& [name, tensor] : stress.items()) {
    for (std::size_t c = 0; c < 6 && name != "total"; ++c) sum[c] += tensor[c].get<double>();
  }
  return sum;
}

TEST(Result, TotalIsTheSumOfItsParts) {
  const Json& stress = usual_result().at("mean").at("stress");
  for (const char* part : {"solvent", "stresslet", "lubrication", "contact_normal", "contact_damping",
                           "friction", "repulsion", "brownian_lubrication", "motion", "total"}) {
    EXPECT_TRUE(stress.contains(part)) << part;
  }
  const std::vector<double> sum = sum_of_parts(stress);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(stress.at("total")[c], sum[c], 1e-12 * std::abs(sum[3]));
}

TEST(Result, AbsentTermsAreAbsent) {
  const Json result = result_of(together({elastic_contacts, {{"repulsion", nullptr}}}));
  std::vector<std::string> names;
  for (const auto& [name, tensor] : result.at("mean").at("stress").items()) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"brownian_lubrication", "contact_normal", "lubrication",
                                             "motion", "solvent", "stresslet", "total"}));
}

TEST(Result, WithoutNoiseNothingIsRandomAndTheMotionIsNoPartOfTheStress) {
  const Json result = result_of({{"fluid", {{"thermal_energy", 0}}}});
  EXPECT_FALSE(result.at("mean").at("stress").contains("brownian_lubrication"));
  EXPECT_FALSE(result.at("mean").at("stress").contains("motion"));
}

TEST(Result, SolventIsOneAndTheStressletTwoAndAHalfVolumeFractions) {
  const Json& stress = usual_result().at("mean").at("stress");
  for (std::size_t c = 0; c < 6; ++c) {
    EXPECT_EQ(stress.at("solvent")[c], c == 3 ? 1 : 0);
    EXPECT_NEAR(stress.at("stresslet")[c], c == 3 ? 2.5 * 0.45 : 0, 1e-12);
  }
}

TEST(Result, ViscosityAndNormalStressesAreThoseOfTheTotal) {
  const Json& mean = usual_result().at("mean");
  const Json& total = mean.at("stress").at("total");  // xx yy zz xy xz yz
  const auto component = [&](std::size_t c) { return total[c].get<double>(); };
  EXPECT_EQ(mean.at("relative_viscosity"), component(3));
  EXPECT_NEAR(mean.at("relative_viscosity_pair"), component(3) - 1 - 2.5 * 0.45, 1e-12 * component(3));
  EXPECT_NEAR(mean.at("first_normal_difference"), component(0) - component(1), 1e-12);
  EXPECT_NEAR(mean.at("second_normal_difference"), component(1) - component(2), 1e-12);
  EXPECT_NEAR(mean.at("pressure"), -(component(0) + component(1) + component(2)) / 3, 1e-12);
  EXPECT_GT(component(3), 1);
  EXPECT_GT(mean.at("pressure"), 0);
}

// Friction sets in at 0.03 sqrt(1e4 kT): 2.1 for kT = 0.5, and 0.03 for 1e-4. The stress is some 1 to 6, that
// of relative viscosities of 5 to 30.
TEST(Result, AStressAtTheOnsetOfFrictionIsSaid) {
  const Json by_rate = Json::object(), by_stress = {{"flow", {{"shear_rate", nullptr}, {"stress", 2}}}};
  for (const Json& flow : {by_rate, by_stress}) {
    for (const double energy : {0.5, 1e-4}) {
      const Json result =
          result_of(together({flow,
                              {{"repulsion", nullptr},
                               {"fluid", {{"thermal_energy", energy}}},
                               {"integrator", {{"method", "implicit"}, {"timestep", "auto"}}}}}));
      const std::string warnings = result.at("warnings").dump();
      EXPECT_EQ(warnings.find("friction sets in near this stress") != std::string::npos, energy == 0.5)
          << warnings;
    }
  }
}

// Single spheres in a wave with m u^2 = 5 have the kinetic stress n kT relative to the flow, though kT = 0.02
// is small. 60 spheres over 100 velocity decay times give a standard error of about 2 %.
TEST(Result, TheStressOfTheMotionIsRelativeToWavesToo) {
  for (const char* method : {"implicit", "explicit"}) {
    const Json result =
        result_of({{"volume_fraction", 0.05},
                   {"contact", nullptr},
                   {"lubrication", nullptr},
                   {"repulsion", nullptr},
                   {"flow", {{"shear_rate", 0}, {"waves", {{{"periods", 1}, {"sine", 5}}}}, {"faxen", true}}},
                   {"integrator", {{"method", method}, {"timestep", 0.0015}}},
                   {"guard", {{"largest_displacement", 10}}},
                   {"duration", {{"equilibration", {{"time", 4}}}, {"production", {{"time", 20}}}}}});
    const Json& motion = result.at("mean").at("stress").at("motion");
    const double mean_volume = 4 * std::numbers::pi / 3 * (44 + 16 * 1.4 * 1.4 * 1.4) / 60;
    const double expected = -0.05 / mean_volume * 0.02;
    EXPECT_NEAR(motion[0].get<double>() / expected, 1, 0.1) << method;
    EXPECT_NEAR(motion[1].get<double>() / expected, 1, 0.1) << method;
  }
}

// Planar extension in x and y, in units of twice the extension rate times the viscosity:
// eta_E = (sigma_xx - sigma_yy) / (4 eta rate), the stress of the noise included.
TEST(Result, TheViscosityOfAnExtensionIsThatOfItsNormalStresses) {
  const Json result = result_of({{"flow", {{"shear_rate", nullptr}, {"extension_rate", 1}}},
                                 {"integrator", {{"method", "implicit"}}},
                                 {"duration", {{"equilibration", {{"time", 0.02}}}}}});
  const Json &mean = result.at("mean"), &total = mean.at("stress").at("total");
  const double expected = (total[0].get<double>() - total[1].get<double>()) / 2;
  EXPECT_NEAR(mean.at("relative_viscosity"), expected, 1e-12 * std::abs(expected));
  EXPECT_NE(mean.at("stress").at("brownian_lubrication")[0], 0);
  const std::vector<double> sum = sum_of_parts(mean.at("stress"));
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(total[c], sum[c], 1e-12 * std::abs(expected));
}

// eta_E / 3 eta = (sigma_xx - (sigma_yy + sigma_zz) / 2) / (3 eta rate), in units of sqrt(3) |rate| eta.
// Negative rates are biaxial extension.
TEST(Result, TheViscosityOfAUniaxialExtensionIsAThirdOfTheExtensionalOne) {
  for (const double rate : {1.0, -1.0}) {
    const Json result = result_of({{"flow", {{"shear_rate", nullptr}, {"uniaxial_rate", rate}}},
                                   {"integrator", {{"method", "implicit"}}},
                                   {"duration", {{"equilibration", {{"time", 0.02}}}}}});
    const Json &mean = result.at("mean"), &total = mean.at("stress").at("total");
    const auto component = [&](std::size_t c) { return total[c].get<double>(); };
    const double expected = (component(0) - (component(1) + component(2)) / 2) / std::sqrt(3.0) * rate;
    EXPECT_NEAR(mean.at("relative_viscosity"), expected, 1e-12 * std::abs(expected));
    // Solvent and stresslets contribute 1 + 2.5 phi.
    const double of_pairs = mean.at("relative_viscosity_pair").get<double>();
    EXPECT_NEAR(expected - of_pairs, 1 + 2.5 * 0.45, 1e-12 * std::abs(expected));
    EXPECT_NEAR(result.at("strain").at("production"), 0.64, 1e-9);  // both signs count
  }
}

// 320 steps make 32 blocks of ten, of equal weight. Blocks have five digits, so each is wrong by at most half
// a unit of the last digit.
void expect_average(const Json& blocks, const Json& mean, const std::string& where) {
  ASSERT_EQ(blocks.size(), 32u) << where;
  double sum = 0, largest_error = 0;
  for (const Json& block : blocks) {
    sum += block.get<double>();
    largest_error += 5e-5 / 32 * std::abs(block.get<double>());
  }
  EXPECT_NEAR(sum / 32, mean.get<double>(), 1e-12 + largest_error) << where;
}

TEST(Result, BlocksAverageToTheMean) {
  const Json& mean = usual_result().at("mean");
  const Json& blocks = usual_result().at("blocks");
  for (const auto& [name, value] : mean.items()) {
    if (value.is_number() && name != "mean_overlap") expect_average(blocks.at(name), value, name);
  }
  // The mean overlap is a mean over contacts.
  double overlaps = 0, contacts = 0;
  for (std::size_t k = 0; k < 32; ++k) {
    const double of_block = blocks.at("contacts_per_particle")[k];
    overlaps += of_block * blocks.at("mean_overlap")[k].get<double>();
    contacts += of_block;
  }
  EXPECT_NEAR(overlaps / contacts, mean.at("mean_overlap"), 1e-4 * overlaps / contacts);
  for (const auto& [term, series] : blocks.at("shear_stress").items()) {
    const Json& whole =
        term == "brownian_structural" ? mean.at("brownian_structural") : mean.at("stress").at(term);
    expect_average(series, whole[3], term);
  }
}

TEST(Result, BlocksHoldWhatFluctuatesAndNothingElse) {
  const Json& blocks = usual_result().at("blocks");
  std::vector<std::string> terms;
  for (const auto& [term, series] : blocks.at("shear_stress").items()) terms.push_back(term);
  EXPECT_EQ(terms,
            (std::vector<std::string>{"brownian_lubrication", "brownian_structural", "contact_damping",
                                      "contact_normal", "friction", "lubrication", "motion", "repulsion"}));
  // Nine numbers and shear_stress; in quarters the stress and the structural Brownian stress.
  EXPECT_EQ(blocks.size(), 12u);
  for (const Json& pressure : blocks.at("pressure")) {
    EXPECT_EQ(pressure.get<double>(), std::stod(fmt::format("{:.4e}", pressure.get<double>())));
  }
}

// A quarter is eight blocks, here of ten steps: xy in quarters is the mean of eight blocks.
TEST(Result, TensorsHaveTheQuartersOfTheWindow) {
  const Json& blocks = usual_result().at("blocks");
  ASSERT_EQ(blocks.at("stress").at("total").size(), 4u);
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    double sum = 0, largest_error = 0;
    for (std::size_t k = 8 * quarter; k < 8 * quarter + 8; ++k) {
      sum += blocks.at("relative_viscosity")[k].get<double>() / 8;
      largest_error += 1e-4 / 8 * std::abs(blocks.at("relative_viscosity")[k].get<double>());
    }
    const Json& total = blocks.at("stress").at("total")[quarter];
    ASSERT_EQ(total.size(), 6u);
    EXPECT_NEAR(total[3].get<double>(), sum, largest_error) << quarter;
  }
  EXPECT_FALSE(blocks.at("stress").contains("solvent"));  // constant
}

TEST(Result, StatesWhatWasSimulated) {
  const Json& result = usual_result();
  EXPECT_EQ(result.at("schema_version"), 1);
  EXPECT_EQ(result.at("point"), "point");
  EXPECT_EQ(result.at("seed"), usual_seed);
  EXPECT_EQ(result.at("method"), "explicit");
  EXPECT_EQ(result.at("timestep"), 0.002);
  EXPECT_EQ(result.at("steps"), (Json{{"equilibration", 100}, {"production", 320}}));
  EXPECT_NEAR(result.at("time").at("production"), 0.64, 1e-12);
  EXPECT_NEAR(result.at("strain").at("production"), 1.28, 1e-12);
  EXPECT_NEAR(result.at("strain").at("equilibration"), 0.4, 1e-12);
  EXPECT_EQ(result.at("units"), "viscosity * shear_rate");
  EXPECT_EQ(result.at("final_state_sha256").get<std::string>().size(), 64u);
  EXPECT_GE(result.at("statistical_inefficiency"), 1);
}

TEST(Result, AtRestStressesAreInTheScenesUnitsAndThereIsNoViscosity) {
  const Json result = result_of(at_rest);
  EXPECT_EQ(result.at("units"), "scene");
  const Json& mean = result.at("mean");
  EXPECT_TRUE(mean.at("relative_viscosity").is_null());
  EXPECT_TRUE(mean.at("relative_viscosity_pair").is_null());
  EXPECT_FALSE(mean.at("stress").contains("solvent"));
  EXPECT_FALSE(mean.at("stress").contains("stresslet"));
}

double variance(const std::vector<double>& series) {
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / static_cast<double>(series.size());
  double sum = 0;
  for (const double x : series) sum += (x - mean) * (x - mean);
  return sum / static_cast<double>(series.size());
}

// Lubrication opposes the noise, so the stress varies less with the stress of the noise than without it.
TEST(Result, AtRestTheStressScattersLessWithThatOfTheNoise) {
  const Json result = result_of(
      together({at_rest, without_friction,
                Json::parse(R"({"repulsion": null, "lubrication": {"inner_gap": 1e-3, "outer_gap": 0.05},
                      "integrator": {"method": "implicit", "timestep": 0.008},
                      "duration": {"production": {"time": 10.24}}})")}));
  const Json& terms = result.at("blocks").at("shear_stress");
  std::vector<double> whole(32), without(32);
  for (std::size_t k = 0; k < 32; ++k) {
    for (const char* term : {"contact_normal", "lubrication", "motion"})
      without[k] += terms.at(term)[k].get<double>();
    whole[k] = without[k] + terms.at("brownian_lubrication")[k].get<double>();
  }
  EXPECT_LT(variance(whole), 0.3 * variance(without));
}

TEST(Result, SameSeedSameBytesButForTheCost) {
  EXPECT_EQ(without_cost(result_of(Json::object())).dump(), without_cost(usual_result()).dump());
}

// Calls look(step, configuration) for every step of the production window.
template <class Look>
void at_every_step(const Json& patch, const Look& look) {
  const Scene scene = scene_from(patch);
  Simulation simulation = started(scene, usual_seed);
  simulation.advance(100);
  for (int step = 0; step < 320; ++step) {
    simulation.advance(1);
    Configuration configuration;
    configuration.physics = scene.physics;
    configuration.particles = simulation.system().particles;
    configuration.box = simulation.system().box;
    look(step, configuration);
  }
}

// Stresslets of spheres in waves depend on positions: the mean over samples, one every ten steps of this
// window, each evaluated again.
TEST(Result, HasTheStressletsOfSpheresWhereTheWavesAre) {
  const Json waves =
      Json::parse(R"([{"periods": 1, "sine": 0.5}, {"periods": 2, "sine": 0.3, "cosine": -0.4}])");
  const Json patch = {{"flow", {{"waves", waves}, {"faxen", true}}}, {"fluid", {{"thermal_energy", 0}}}};
  double sum = 0;
  at_every_step(patch, [&](int step, const Configuration& configuration) {
    if (step % 10 != 0) return;
    sum += evaluate_configuration(configuration).at("stress").at("stresslet")[0][1].get<double>();
  });
  const Json result = result_of(patch);
  const double found = result.at("mean").at("stress").at("stresslet")[3];
  constexpr double unit = 0.1 * 2;  // viscosity times rate
  EXPECT_NEAR(found, sum / 32 / unit, 1e-12 * std::abs(found));
  EXPECT_GT(std::abs(found - 2.5 * 0.45), 1e-3);
  EXPECT_TRUE(result.at("gate").at("energy_imbalance").is_null());
  EXPECT_TRUE(result.at("gate").at("half_step_difference").is_null());
  EXPECT_EQ(result.at("blocks").at("stress").at("stresslet").size(), 4U);
}

// Contact and repulsion depend on positions alone; every step of the window is evaluated again, one
// configuration at a time.
TEST(Result, MeansAreTakenOverEveryStepOfTheProductionWindow) {
  std::map<std::string, double> sums;
  double contacts = 0, overlaps = 0, largest_overlap = 0;
  at_every_step(Json::object(), [&](int, const Configuration& configuration) {
    const ParticleState& p = configuration.particles;
    const Json stress = evaluate_configuration(configuration).at("stress");
    for (const char* term : {"contact_normal", "repulsion"}) {
      sums[term] += stress.at(term)[0][1].get<double>();
      sums[std::string(term) + " zz"] += stress.at(term)[2][2].get<double>();
    }
    for (const SeenPair& pair :
         every_image(p.position, configuration.box.lengths(), configuration.box.tilt(),
                     [&](std::uint32_t i, std::uint32_t j) { return p.radius[i] + p.radius[j]; })) {
      ++contacts;
      const double overlap = (p.radius[pair.first] + p.radius[pair.second] - norm(pair.separation)) /
                             std::min(p.radius[pair.first], p.radius[pair.second]);
      overlaps += overlap;
      largest_overlap = std::max(largest_overlap, overlap);
    }
  });
  const Json& mean = usual_result().at("mean");
  constexpr double unit = 0.1 * 2 * 320;  // viscosity times rate times steps
  for (const char* term : {"contact_normal", "repulsion"}) {
    const Json& found = mean.at("stress").at(term);
    EXPECT_NEAR(found[3], sums[term] / unit, 1e-11 * std::abs(sums[term] / unit)) << term;
    const double zz = sums[std::string(term) + " zz"] / unit;
    EXPECT_NEAR(found[2], zz, 1e-11 * std::abs(zz)) << term;
  }
  EXPECT_NEAR(mean.at("contacts_per_particle"), 2 * contacts / 320 / 60, 1e-12);
  EXPECT_NEAR(mean.at("mean_overlap"), overlaps / contacts, 1e-12);
  EXPECT_NEAR(usual_result().at("largest_overlap"), largest_overlap, 1e-12);
}

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
  const Json resting =
      together({at_rest, {{"observables", {"mean_squared_displacement", "stress_correlation"}}}});
  const Json result_at_rest = result_of(resting);
  const Json responding = result_of(
      together({at_rest,
                elastic_contacts,
                {{"duration", {{"production", {{"time", 1.2}}}}}, {"observables", {"linear_response"}}}}));
  EXPECT_TRUE(responding.at("quantities").contains("zero_shear_viscosity"));
  EXPECT_EQ(responding.at("mean").at("relative_viscosity"), responding.at("mean").at("zero_shear_viscosity"));
  for (const Json& result : {sheared, result_at_rest, responding}) {
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
  EXPECT_EQ(result_at_rest.at("quantities").at("pressure").at("unit"), "stress");
  EXPECT_FALSE(result_at_rest.at("quantities").contains("relative_viscosity"));
  // The axes are those of the lags.
  for (const char* name : {"mean_squared_displacement", "stress_correlation"}) {
    const std::string vector = std::string(name) + (name[0] == 'm' ? "/all/y" : "/modulus");
    EXPECT_EQ(result_at_rest.at("quantities").at(vector).at("axes")[0].at("values"),
              result_at_rest.at("mean").at(name).at("time"))
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
