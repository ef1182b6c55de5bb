#include "runner/statistics/curve_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace peclet::runner {
namespace {

using Data = std::vector<CurveFit::Datum>;

// The curve of tests/reference/curve.py, which printed the numbers below.
const std::array axes{0.01, 0.05, 0.2, 1.0, 5.0, 20.0, 100.0};
Data known() {
  constexpr std::array mean{7.5, 7.1, 6.6, 5.4, 5.0, 6.1, 7.4};
  constexpr std::array error{0.5, 0.3, 0.2, 0.1, 0.08, 0.1, 0.09};
  constexpr std::array count{8, 10, 13, 8, 8, 17, 8};
  Data data;
  for (std::size_t i = 0; i < axes.size(); ++i) data.push_back({axes[i], mean[i], error[i], count[i]});
  return data;
}

void expect_values(const std::vector<CurveFit::Value>& values, const std::vector<double>& mean,
                   const std::vector<double>& deviation) {
  constexpr double rounding = 1e-6;
  ASSERT_EQ(values.size(), mean.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i].mean, mean[i], rounding) << i;
    EXPECT_NEAR(values[i].deviation, deviation[i], rounding) << i;
  }
}

TEST(CurveFit, HasTheBandsOfAnotherEvaluation) {
  const CurveFit fit(known());
  expect_values(fit.at(axes), {2.0066152, 1.9674754, 1.8790641, 1.6848638, 1.6185034, 1.8029316, 2.0016306},
                {0.072732, 0.0406967, 0.0298625, 0.0206506, 0.0189047, 0.0174662, 0.0143703});
  expect_values(fit.at(std::array{0.02, 2.0, 50.0}), {1.9952128, 1.6220521, 1.933875},
                {0.0624159, 0.0401514, 0.0410525});
}

TEST(CurveFit, HasTheResidualsOfFitsWithoutTheDatum) {
  constexpr std::array distance{0.250399, -0.134046, 0.281939, -0.123666, -0.909654, 0.611083, 0.20688};
  constexpr std::array allowed{3.171609, 3.052836, 2.953813, 3.171609, 3.171609, 2.883027, 3.171609};
  const CurveFit fit(known());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    EXPECT_NEAR(fit.residuals()[i].distance, distance[i], 1e-6) << i;
    EXPECT_NEAR(fit.residuals()[i].allowed, allowed[i], 1e-6) << i;
  }
  EXPECT_FALSE(fit.is_refused());
}

// The variance without one more value, less that with it.
TEST(CurveFit, KnowsWhatAnotherValueWouldGain) {
  CurveFit::Outlook outlook = CurveFit(known()).outlook(axes);
  const Eigen::VectorXd before = outlook.variances();
  EXPECT_NEAR(before[0], 0.072732 * 0.072732, 1e-7);
  outlook.take(3, 0.001);
  const Eigen::VectorXd gain = before - outlook.variances();
  EXPECT_NEAR(gain[0], 5.576974e-7, 1e-11);
  EXPECT_NEAR(gain[2], 6.8881153e-6, 1e-11);
  EXPECT_NEAR(gain[3], 1.26854352e-4, 1e-11);
}

// The gain at each place over the cost of the offer, as take() finds it.
TEST(CurveFit, KnowsTheBestOfSeveralOffers) {
  const CurveFit::Outlook outlook = CurveFit(known()).outlook(axes);
  std::vector<std::optional<CurveFit::Outlook::Offer>> offers(axes.size());
  offers[1] = {0.001, 2};
  offers[3] = {0.001, 1};
  offers[5] = {0.01, 0.1};
  const Eigen::VectorXd before = outlook.variances();
  const std::vector<std::size_t> best = outlook.best(offers);
  for (std::size_t place = 0; place < axes.size(); ++place) {
    const auto gain = [&](std::size_t offered) {
      CurveFit::Outlook taken = outlook;
      taken.take(offered, offers[offered]->noise);
      const auto i = static_cast<Eigen::Index>(place);
      return (before[i] - taken.variances()[i]) / offers[offered]->cost;
    };
    for (const std::size_t other : {1U, 3U, 5U}) EXPECT_GE(gain(best[place]), gain(other)) << place;
  }
  EXPECT_NE(best[0], best[6]);
  EXPECT_EQ(outlook.best(std::vector<std::optional<CurveFit::Outlook::Offer>>(axes.size())),
            (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
}

// A unit is a factor, which a logarithm turns into a constant.
TEST(CurveFit, DoesNotDependOnUnits) {
  Data other = known();
  for (CurveFit::Datum& datum : other) {
    datum.axis *= 1e3;
    datum.mean *= 1e-6;
    datum.standard_error *= 1e-6;
  }
  const CurveFit fit(known()), in_other_units(other);
  const CurveFit::Value one = fit.at(std::array{0.02}).front();
  const CurveFit::Value same = in_other_units.at(std::array{20.0}).front();
  EXPECT_NEAR(same.mean, one.mean + std::log(1e-6), 1e-9);
  EXPECT_NEAR(same.deviation, one.deviation, 1e-9);
}

// An axis with a value below 0 has no logarithm: the same curve at places of equal distances.
TEST(CurveFit, TakesAnAxisAsItIsIfItHasNoLogarithm) {
  Data logarithmic, linear;
  for (int i = 0; i < 6; ++i) {
    const double mean = 5 + std::sin(0.7 * i);
    logarithmic.push_back({std::exp(i - 2), mean, 0.1, 8});
    linear.push_back({i - 2.0, mean, 0.1, 8});
  }
  const CurveFit one(logarithmic), other(linear);
  EXPECT_NEAR(one.at(std::array{std::exp(0.5)})[0].mean, other.at(std::array{0.5})[0].mean, 1e-9);
}

// Eight points of a power law, one of them 12 % too high with an error of 2 %.
TEST(CurveFit, IsRefusedIfAPointContradictsIt) {
  Data data;
  for (int i = 0; i < 8; ++i) {
    const double axis = std::pow(4.0, i), mean = 5 * std::pow(axis, 0.3) * (i % 2 == 0 ? 1.005 : 0.995);
    data.push_back({axis, mean, 0.02 * mean, 30});
  }
  EXPECT_FALSE(CurveFit(data).is_refused());
  data[4].mean *= 1.12;
  const CurveFit fit(data);
  EXPECT_TRUE(fit.is_refused());
  EXPECT_TRUE(fit.residuals()[4].contradicts());
}

// A curve that falls from 10 at rest as 1 / (1 + axis^2 / 100).
Data from_rest(double at_rest) {
  Data data{{0, at_rest, 0.1, 20}};
  for (const double axis : {0.1, 0.5, 2.0, 10.0, 50.0, 200.0}) {
    const double mean = 2 + 8 / (1 + axis * axis / 100);
    data.push_back({axis, mean, axis < 0.2 ? 2.0 : 0.05, 20});
  }
  return data;
}

TEST(CurveFit, IsHeldByTheValueAtRest) {
  const Data data = from_rest(10);
  EXPECT_TRUE(CurveFit::serves_as_anchor(data));
  const CurveFit::Value lowest = CurveFit(data, true).at(std::array{0.1}).front();
  EXPECT_NEAR(lowest.mean, std::log(10), 0.03);
  EXPECT_LT(lowest.deviation, 0.015);  // a point of 20 % alone
  const Data without(data.begin() + 1, data.end());
  EXPECT_GT(CurveFit(without).at(std::array{0.1}).front().deviation, 0.03);
}

// If the next point is at twice the smallest axis only, a square leaves a quarter of its difference.
TEST(CurveFit, IsNotHeldByAValueAtRestThatMayBeFarOff) {
  Data data = from_rest(10);
  data[2].axis = 0.2;
  data[2].standard_error = 2;
  EXPECT_FALSE(CurveFit::serves_as_anchor(data));
  EXPECT_FALSE(CurveFit::serves_as_anchor(Data(data.begin() + 1, data.end())));  // none at rest
}

}  // namespace
}  // namespace peclet::runner
