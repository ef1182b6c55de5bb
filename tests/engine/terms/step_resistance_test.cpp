// The resistance of a pair within a step, compared with its formulas and with averages by quadrature.
#include "engine/terms/step_resistance.h"

#include <gtest/gtest.h>

#include <functional>

namespace peclet::engine {
namespace {

constexpr double first = 1, second = 1.4, sum = first + second, timestep = 0.3;
// Both forms, with equal bounds of the argument of the resistance: xi, or xi + inner_gap.
constexpr LubricationParameters lubrication = {1e-2, 0.1};
constexpr LubricationParameters shifted = {
    .inner_gap = lubrication.inner_gap,
    .form = LubricationParameters::Form::mari,
    .outer_distance = 0.5 * sum * (lubrication.outer_gap - lubrication.inner_gap)};
constexpr LubricationParameters forms[] = {lubrication, shifted};

constexpr double shift_of(const LubricationParameters& form) {
  return form.form == LubricationParameters::Form::mari ? form.inner_gap : 0;
}

// Returns 1/xi, or below L, at a gap within the range.
double inverse(double gap) {
  return gap <= lubrication.outer_gap ? 1 / std::max(gap, lubrication.inner_gap) : 0;
}
double logarithm_of(double gap) {
  return gap <= lubrication.outer_gap ? -std::log(std::max(gap, lubrication.inner_gap)) : 0;
}

double average(const std::function<double(double)>& f, double from, double to) {
  constexpr int parts = 400'000;
  double mean = 0;
  for (int k = 0; k < parts; ++k) mean += f(from + (to - from) * (k + 0.5) / parts) / parts;
  return mean;
}

PairGeometry pair_of(const LubricationParameters& form, double gap) {
  const double distance = sum * (1 + 0.5 * (gap - shift_of(form)));
  return {{distance, 0, 0}, {1, 0, 0}, distance, sum};
}

// Returns the modes of a pair in the middle of a displacement between two gaps.
ResistanceModes modes(const LubricationParameters& form, StepResistance::Part part, double from, double to) {
  const double closing = 0.5 * sum * (to - from) / timestep;
  return resistance_modes(StepResistance{part, timestep}, lubricated_gap(form, sum),
                          lubrication_range(form, sum), pair_of(form, 0.5 * (from + to)), closing);
}

struct Way {
  double from, to;
};
// Within the range, into and out of the inner gap, out of and into the range, through everything, and beyond.
constexpr Way ways[] = {{0.02, 0.05}, {0.05, 0.02}, {0.03, -0.02}, {-0.02, 0.03}, {-0.03, -0.01},
                        {0.08, 0.13}, {0.13, 0.08}, {-0.01, 0.12}, {0.12, -0.01}, {0.13, 0.15}};

TEST(StepResistance, OnTheWayIsTheAverageOverItsGaps) {
  for (const auto& [from, to] : ways) {
    const double inverse_mean = average(inverse, from, to), logarithm_mean = average(logarithm_of, from, to);
    for (const LubricationParameters& form : forms) {
      const ResistanceModes found = modes(form, StepResistance::Part::on_the_way, from, to);
      EXPECT_NEAR(found.inverse, inverse_mean, 1e-4 / lubrication.inner_gap) << from << ' ' << to;
      EXPECT_NEAR(found.logarithm, logarithm_mean, 1e-4) << from << ' ' << to;
      EXPECT_NEAR(found.lever, shift_of(form) > 0 ? 1 : 1 + 0.25 * (from + to), 1e-12);
    }
  }
}

// Steps from one initial gap, by differences of the force X_A dr/dt; other modes keep their averages.
TEST(StepResistance, TheTangentIsTheDerivativeOfTheSqueezingForce) {
  for (const LubricationParameters& form : forms) {
    const ResistanceConstants k = resistance_constants(0.1, first, second, form.form);
    const auto mean = [&](double from, double to) {
      return pair_resistance(k, modes(form, StepResistance::Part::on_the_way, from, to));
    };
    const auto force = [&](double from, double to) {
      return mean(from, to).squeeze * 0.5 * sum * (to - from) / timestep;
    };
    for (const auto& [from, to] : ways) {
      const double d = 1e-6;
      const double closing = 0.5 * sum * (to - from) / timestep, change = sum * d / timestep;
      const PairResistance tangent = tangent_resistance(
          k, StepResistance{StepResistance::Part::on_the_way, timestep}, lubricated_gap(form, sum),
          lubrication_range(form, sum), pair_of(form, 0.5 * (from + to)), closing);
      EXPECT_NEAR(tangent.squeeze, (force(from, to + d) - force(from, to - d)) / change,
                  1e-4 * k.squeeze_inverse / lubrication.inner_gap)
          << from << ' ' << to;
      EXPECT_DOUBLE_EQ(tangent.shear, mean(from, to).shear);
      EXPECT_DOUBLE_EQ(tangent.twist_cross, mean(from, to).twist_cross);
    }
  }
}

// For a pair at rest every part is R, or R minus half of the jump.
TEST(StepResistance, OfAPairAtRestIsThatOfItsGap) {
  const double jump = 1 / lubrication.outer_gap, log_jump = std::log(jump);
  for (const double gap : {-0.02, 0.005, 0.02, 0.09, 0.11}) {
    const double within = gap <= lubrication.outer_gap ? 1 : 0;
    for (const LubricationParameters& form : forms) {
      for (const auto part : {StepResistance::Part::at_beginning, StepResistance::Part::ahead}) {
        const ResistanceModes found = modes(form, part, gap, gap);
        EXPECT_NEAR(found.inverse, inverse(gap) - 0.5 * jump * within, 1e-3) << gap;
        EXPECT_NEAR(found.logarithm, logarithm_of(gap) - 0.5 * log_jump * within, 1e-5) << gap;
      }
      for (const auto part : {StepResistance::Part::whole, StepResistance::Part::on_the_way}) {
        EXPECT_NEAR(modes(form, part, gap, gap).inverse, inverse(gap), 1e-3) << gap;
        EXPECT_NEAR(modes(form, part, gap, gap).logarithm, logarithm_of(gap), 1e-5) << gap;
      }
    }
  }
}

// The rule of step_resistance.h, with the averages by quadrature.
TEST(StepResistance, AheadIsTheMeanOfItsTwoRulesAndHalfOfTheJump) {
  const double inner = lubrication.inner_gap, outer = lubrication.outer_gap;
  for (const auto& way : ways) {
    const double from = way.from, to = way.to;
    const double start = std::max(from, inner), e = 1 / (4 * inner);
    const auto root = [&](double end) { return std::sqrt(start * std::max(end, inner)); };
    const double left = (1 / start + e) / (1 / root(to) + e);
    const double end = from + (to - from) * (1 - 0.65 + 0.65 * left);
    const auto rest = [&](const std::function<double(double)>& mode) {
      const auto continuous = [&](double gap) { return mode(std::min(gap, outer)) - mode(outer); };
      return 0.5 * (average(continuous, from, end) + continuous(root(end))) +
             (from <= outer ? 0.5 * mode(outer) : 0);
    };
    const double inverse_there = rest(inverse), logarithm_there = rest(logarithm_of);
    for (const LubricationParameters& form : forms) {
      const ResistanceModes found = modes(form, StepResistance::Part::ahead, from, to);
      EXPECT_NEAR(found.inverse, inverse_there, 1e-6 / inner) << from << ' ' << to;
      EXPECT_NEAR(found.logarithm, logarithm_there, 1e-6) << from << ' ' << to;
    }
  }
}

// Fixman's drift needs the resistance at the middle of the predicted step, to first order in its length.
TEST(StepResistance, AheadIsThatOfTheMiddleToFirstOrder) {
  const double gap = 0.03;
  const auto error = [&](double way) {
    return modes(lubrication, StepResistance::Part::ahead, gap - 0.5 * way, gap + 0.5 * way).inverse -
           (1 / gap - 0.5 / lubrication.outer_gap);
  };
  for (const double sign : {-1, 1}) EXPECT_NEAR(error(sign * 1e-3) / error(sign * 5e-4), 4, 0.4);
}

}  // namespace
}  // namespace peclet::engine
