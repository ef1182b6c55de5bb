#include "tests/bench/engine/counted_links.h"

#include <gtest/gtest.h>

#include "tests/bench/engine/catalogue.h"
#include "tests/bench/engine/solver_cost.h"
#include "tests/engine/every_image.h"
#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

Links links_of(InstructionSet set = InstructionSet::baseline) {
  const Physics physics = physics_with({.lubrication = true, .contact = true});
  return Links(physics, dense_suspension(physics, 300, 5), set);
}

std::span<const LinkLevel> levels_of(const LinkSystem& system) {
  return {system.levels, system.blocks[system.count_of_blocks - 1].levels_end};
}

// Returns the squared residual that the compiled kernels leave after equally many iterations.
double squared_residual(const Links& links, const std::vector<MotionRow>& right, int iterations) {
  SolverStorage storage(right.size());
  storage.of[0] = right;
  Team alone;
  const double squared = links.kernels().begin(links.view(), storage.view(), alone);
  return links.kernels().solve(links.view(), storage.view(), squared, 0, iterations, alone).squared_residual;
}

TEST(SolverOperations, AreThoseOfWorkThatGivesTheKernelsResult) {
  for (const InstructionSet set : available_sets()) {
    const Links links = links_of(set);
    const std::vector<MotionRow> right = random_rows(links.system().particles.count(), 7);
    for (const int iterations : {1, 6}) {
      const double expected = squared_residual(links, right, iterations);
      EXPECT_NEAR(count_solver_operations(links.view(), right.data(), iterations).squared_residual, expected,
                  1e-4 * expected);
    }
  }
}

TEST(SolverOperations, AreTheSameInEveryIteration) {
  const Links links = links_of();
  const std::vector<MotionRow> right = random_rows(links.system().particles.count(), 7);
  EXPECT_EQ(count_solver_operations(links.view(), right.data(), 1).iteration,
            count_solver_operations(links.view(), right.data(), 5).iteration);
}

// A = L D L^T of a 6 x 6 matrix divides once by each of six pivots. Rows of a level are done eight at a time.
TEST(SolverOperations, OfTheFactorisationAreSixQuotientsForEachRow) {
  const Links links = links_of();
  const LinkSystem system = links.view();
  std::uint64_t rows = 0;
  for (const LinkLevel& level : levels_of(system)) {
    rows += std::uint64_t{(level.rows_end - level.rows_begin + 7) / 8} * 8;
  }
  const std::vector<MotionRow> right = random_rows(links.system().particles.count(), 7);
  const SolverOperations done = count_solver_operations(system, right.data(), 1);
  EXPECT_EQ(done.factorisation.quotients, 6 * rows);
  EXPECT_EQ(done.iteration.quotients, 0u);
}

// Each of the two sweeps of an iteration multiplies six numbers of a row by the six columns of P^-1, and one
// sweep also by K. A link adds its load of six numbers to its row.
TEST(SolverOperations, OfAnIterationAreAtLeastThoseOfItsProducts) {
  const Links links = links_of();
  const LinkSystem system = links.view();
  const std::span<const LinkLevel> given = levels_of(system);
  std::vector<LinkLevel> levels(given.begin(), given.end());
  std::uint64_t places = 0;
  for (LinkLevel& level : levels) {
    places += std::uint64_t{level.count_of_groups + (level.count_of_crossing + 7) / 8} * links_per_group;
    level.count_of_groups = level.count_of_crossing = 0;
    level.incoming_end = level.incoming_begin;
  }
  LinkSystem without_links = system;
  without_links.levels = levels.data();
  const std::vector<MotionRow> right = random_rows(system.particles, 7);
  const Operations of_rows = count_solver_operations(without_links, right.data(), 1).iteration;
  const Operations of_links = count_solver_operations(system, right.data(), 1).iteration - of_rows;
  EXPECT_GE(of_rows.products, (2 * 36 + 9) * system.particles);
  EXPECT_EQ(of_rows.products % system.particles, 0u);
  EXPECT_GE(of_links.sums, 12 * places);
  EXPECT_EQ(of_links.products % places, 0u);
}

// Without motion within the step, the links are the near pairs.
TEST(SolverCost, IsThatOfEveryNearPair) {
  const Scene scene = chosen_groups({"implicit"}).at(0).contestants.at(0).scene;
  const System system = dense_suspension(scene.physics, 200, 5);
  const double outer = 1 + 0.5 * scene.physics.lubrication->outer_gap;
  const std::size_t near = count_near(system, outer);
  const SolverCost cost = solver_cost(scene, system, 1e-9);
  EXPECT_EQ(cost.rows, 200);
  EXPECT_EQ(cost.links, static_cast<double>(near));
  // Six to ten colours serve any suspension (link_order.h).
  EXPECT_GE(cost.levels, 2u);
  EXPECT_LE(cost.levels, 16u);
  EXPECT_GT(cost.iteration.median, 0);
  // An iteration reads each number in its memory range at least once.
  EXPECT_GE(cost.bytes, static_cast<double>(cost.room));
}

}  // namespace
}  // namespace peclet::engine
