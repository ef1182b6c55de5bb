#include "tests/engine/pair_evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/engine/bits.h"

namespace peclet::engine {

std::vector<Terms> every_recipe() {
  std::vector<Terms> recipes;
  for (unsigned code = 0; code < count_of_codes; ++code) {
    if (decoded_terms(code).valid()) recipes.push_back(decoded_terms(code));
  }
  return recipes;
}

std::string text(const Terms& terms) {
  std::string all;
  for (const NamedTerm& term : every_term) all += terms.*term.chosen ? std::string(term.name) + ' ' : "";
  return all;
}

Evaluation evaluated(const Physics& physics, System system, int threads, InstructionSet set) {
  const std::size_t count = system.particles.count();
  Evaluation result{VectorField(count), VectorField(count), {}, {}};
  result.sums = ForceField(physics, system.particles, timestep, seed, threads, set)
                    .evaluate(system, result.force, result.torque);
  result.springs = system.springs;
  return result;
}

std::vector<double> components(const VectorField& field) {
  std::vector<double> all;
  for (std::size_t i = 0; i < field.size(); ++i) {
    all.insert(all.end(), {field[i].x, field[i].y, field[i].z});
  }
  return all;
}

std::vector<double> components(const PairSums& sums) {
  std::vector<double> all;
  for (const SymmetricTensor& s : sums.stress) {
    all.insert(all.end(), {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz});
  }
  return all;
}

std::vector<double> components(const SpringField& springs) {
  std::vector<double> all;
  for (std::size_t c = 0; c < springs.components(); ++c) {
    all.insert(all.end(), springs.values(c).begin(), springs.values(c).end());
  }
  return all;
}

void expect_near(const std::vector<double>& expected, const std::vector<double>& found,
                 const std::string& what, double bound) {
  ASSERT_EQ(expected.size(), found.size()) << what;
  double scale = 0;
  for (const double x : expected) scale = std::max(scale, std::abs(x));
  std::size_t differing = 0;
  double worst = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double difference = std::abs(expected[k] - found[k]);
    differing += difference <= bound * scale ? 0 : 1;  // counts a NaN as different
    worst = std::max(worst, difference);
  }
  EXPECT_EQ(differing, 0u) << what << ": up to " << worst << " of " << scale;
}

void expect_near(const Evaluation& expected, const Evaluation& found, const std::string& what) {
  expect_near(components(expected.force), components(found.force), what + " force");
  expect_near(components(expected.torque), components(found.torque), what + " torque");
  expect_near(components(expected.sums), components(found.sums), what + " stress");
  expect_near(components(expected.springs), components(found.springs), what + " springs");
  EXPECT_EQ(expected.sums.contacts, found.sums.contacts) << what;
  EXPECT_NEAR(expected.sums.largest_overlap, found.sums.largest_overlap, 1e-15) << what;
}

void expect_same_bits(const Evaluation& expected, const Evaluation& found, const std::string& what) {
  EXPECT_EQ(components(expected.force), components(found.force)) << what;
  EXPECT_EQ(components(expected.torque), components(found.torque)) << what;
  EXPECT_EQ(bits_of(std::to_array(expected.sums.stress)), bits_of(std::to_array(found.sums.stress))) << what;
  EXPECT_EQ(expected.sums.contacts, found.sums.contacts) << what;
  EXPECT_EQ(expected.sums.largest_overlap, found.sums.largest_overlap) << what;
  ASSERT_EQ(expected.springs.size(), found.springs.size()) << what;
  for (std::size_t p = 0; p < expected.springs.size(); ++p) {
    EXPECT_EQ(bits_of(expected.springs[p]), bits_of(found.springs[p])) << what;
  }
}

void expect_same_bits_on_threads(const Physics& physics, const System& system) {
  const Evaluation one = evaluated(physics, system, 1);
  for (const int threads : {2, 3}) {
    expect_same_bits(one, evaluated(physics, system, threads), std::to_string(threads) + " threads");
  }
}

void expect_single_twin(const Physics& physics, const System& system, InstructionSet set,
                        const std::string& what) {
  expect_near(evaluated(physics, system, 1, InstructionSet::baseline), evaluated(physics, system, 1, set),
              what + name_of(set));
}
}  // namespace peclet::engine
