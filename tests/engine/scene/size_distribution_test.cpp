// The few sizes that represent a distribution, compared with its moments in closed form.
#include "engine/scene/size_distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace peclet::engine {
namespace {

using Form = SizeDistribution::Form;

// Returns the mean of a^p over the numbers of spheres.
double moment(const std::vector<SizeClass>& sizes, double power) {
  double sum = 0;
  for (const SizeClass& size : sizes) sum += size.number * std::pow(size.radius, power);
  return sum;
}

struct Case {
  std::string name;
  SizeDistribution distribution;
  std::function<double(double)> integral;  // integral of a^p times the density, up to a factor
};

// The mean of a^p over a lognormal density of mean m and relative width c: m^p (1 + c^2)^(p (p - 1) / 2).
Case lognormal(double m, double c, bool by_volume) {
  return {"lognormal " + std::to_string(c), {Form::lognormal, m, c, by_volume, 16}, [=](double p) {
            return std::pow(m, p) * std::pow(1 + c * c, p * (p - 1) / 2);
          }};
}

Case uniform(double m, double c, bool by_volume) {
  const double low = m * (1 - std::sqrt(3) * c), high = m * (1 + std::sqrt(3) * c);
  return {"uniform " + std::to_string(c), {Form::uniform, m, c, by_volume, 16}, [=](double p) {
            if (p == -1) return std::log(high / low);
            return (std::pow(high, p + 1) - std::pow(low, p + 1)) / (p + 1);
          }};
}

// A symmetric density has no third central moment.
Case gaussian(double m, double c) {
  return {"gaussian " + std::to_string(c), {Form::gaussian, m, c, false, 16}, [=](double p) {
            const double variance = m * m * c * c;
            if (p == 0) return 1.0;
            if (p == 1) return m;
            return p == 2 ? m * m + variance : m * m * m + 3 * m * variance;
          }};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const bool by_volume : {false, true}) {
    for (const double c : {0.05, 0.2, 0.5}) cases.push_back(lognormal(2, c, by_volume));
    for (const double c : {0.05, 0.2, 0.5}) cases.push_back(uniform(2, c, by_volume));
  }
  for (const double c : {0.05, 0.2, 0.3}) cases.push_back(gaussian(2, c));
  return cases;
}

TEST(SizeDistribution, KeepsItsMoments) {
  for (const Case& one : all_cases()) {
    const std::vector<SizeClass> sizes = size_classes(one.distribution);
    ASSERT_EQ(sizes.size(), 16U);
    EXPECT_NEAR(moment(sizes, 0), 1, 1e-12) << one.name;
    // A density by volume becomes one by number after division by a^3.
    const double shift = one.distribution.by_volume ? 3 : 0;
    for (const double p : {1.0, 2.0, 3.0}) {
      const double exact = one.integral(p - shift) / one.integral(-shift);
      const double error = moment(sizes, p) / exact - 1;
      EXPECT_LT(std::abs(error), p == 3 ? 2e-5 : 5e-3) << one.name << " moment " << p;
      if (p < 3) {
        EXPECT_GT(error, 0) << one.name << " moment " << p;
      }
    }
  }
}

TEST(SizeDistribution, FinerClassesAreNearer) {
  for (Case one : {lognormal(1, 0.4, false), uniform(1, 0.4, false), gaussian(1, 0.3)}) {
    double last = 1;
    for (const std::size_t classes : {1U, 4U, 16U, 64U}) {
      one.distribution.classes = classes;
      const double exact = one.integral(1) / one.integral(0);
      const double error = std::abs(moment(size_classes(one.distribution), 1) / exact - 1);
      EXPECT_LT(error, 0.4 * last) << one.name << ' ' << classes;
      last = error;
    }
  }
}

// One size has the mean volume: (1 + c^2) m for a lognormal distribution.
TEST(SizeDistribution, OneClassHasTheMeanVolume) {
  const std::vector<SizeClass> sizes = size_classes({Form::lognormal, 2, 0.5, false, 1});
  ASSERT_EQ(sizes.size(), 1U);
  EXPECT_NEAR(sizes[0].radius, 2.5, 1e-5);
  EXPECT_NEAR(sizes[0].number, 1, 1e-12);
}

TEST(SizeDistribution, NoClassHasMoreThanTwiceItsPart) {
  for (const Case& one : all_cases()) {
    const std::vector<SizeClass> sizes = size_classes(one.distribution);
    const double volume = moment(sizes, 3);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const double number = sizes[k].number, of_volume = number * std::pow(sizes[k].radius, 3) / volume;
      EXPECT_NEAR((number + of_volume) / 2, 1.0 / 16, 1e-5) << one.name << ' ' << k;
      if (k > 0) {
        EXPECT_GT(sizes[k].radius, sizes[k - 1].radius) << one.name;
      }
    }
  }
}

TEST(SizeDistribution, RadiiHaveSixDigits) {
  for (const SizeClass& size : size_classes({Form::lognormal, 1, 0.3, false, 16})) {
    const double unit = size.radius < 1 ? 1e-6 : 1e-5;
    EXPECT_NEAR(size.radius / unit, std::round(size.radius / unit), 1e-6);
  }
}

}  // namespace
}  // namespace peclet::engine
