// Systems of more than one block: links between blocks, and rows that several blocks work on.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

class LinkBlocksOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, LinkBlocksOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

using Block = Eigen::Matrix<double, 6, 6>;

Links linked(InstructionSet set) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  Links links(physics, dense_suspension(physics, 4500, 7), set);
  EXPECT_EQ(links.order().blocks().size(), 2u);
  EXPECT_GT(links.system().list.crossings(), 500u);
  return links;
}

// Returns A times a vector of rows.
std::vector<MotionRow> product(const Links& links, const std::vector<MotionRow>& vector) {
  std::vector<MotionRow> result(vector.size());
  links.kernels().multiply(links.view(), vector.data(), result.data());
  return result;
}

// Returns the diagonal block of A for each row, from motions of all rows of a level, which are not linked.
std::vector<Block> own_blocks(const Links& links) {
  std::vector<Block> blocks(links.system().particles.count());
  for (const LinkLevel& level : links.order().levels()) {
    for (std::size_t k = 0; k < 6; ++k) {
      std::vector<MotionRow> units(blocks.size());
      for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) units[i].v[of_a_motion[k]] = 1;
      const std::vector<MotionRow> moved = product(links, units);
      for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) {
        blocks[i].col(static_cast<Eigen::Index>(k)) = entries(moved[i])(of_a_motion);
      }
    }
  }
  return blocks;
}

// P by the formula of link_kernels.h, and K.
struct Pivots {
  std::vector<Block> whole;
  std::vector<Eigen::Matrix3d> squeezing;
};
Pivots pivots_of(const Links& links) {
  Pivots pivots{own_blocks(links), {}};
  pivots.squeezing.resize(pivots.whole.size(), Eigen::Matrix3d::Zero());
  for (const LinkGroup& group : groups_in_order(links.view())) {
    for (int k = 0; k < links_per_group; ++k) {
      const Eigen::Vector3d n = normal_of(group, k);
      const auto squeeze = static_cast<double>(group.squeeze[k]);
      const Block inverse = pivots.whole[group.second[k]].inverse();
      const double compliance = n.dot(inverse.topLeftCorner<3, 3>() * n);
      const Eigen::Matrix3d added = 0.9 * squeeze * squeeze * compliance * n * n.transpose();
      pivots.squeezing[group.first[k]] += added;
      pivots.whole[group.first[k]].topLeftCorner<3, 3>() -= added;
    }
  }
  return pivots;
}

TEST_P(LinkBlocksOf, KeepRowsOfALevelApart) {
  const Links links = linked(GetParam());
  const LinkSystem system = links.view();
  std::vector<std::uint32_t> level(system.particles);
  std::size_t rows = 0;
  for (std::uint32_t l = 0; l < links.order().levels().size(); ++l) {
    for (std::uint32_t i = system.levels[l].rows_begin; i < system.levels[l].rows_end; ++i, ++rows)
      level[i] = l;
  }
  EXPECT_EQ(rows, system.particles);
  // The boundary's levels span all blocks.
  const auto rank = [&](std::uint32_t row) {
    const LinkBlock& block = system.blocks[row < system.blocks[0].rows_end ? 0 : 1];
    const bool interior = level[row] < block.boundary_begin;
    return interior ? level[row] - block.levels_begin : 1000 + level[row] - block.boundary_begin;
  };
  for (const Pair& pair : links.system().list.pairs()) {
    EXPECT_NE(rank(system.row[pair.first]), rank(system.row[pair.second]));
  }
}

TEST_P(LinkBlocksOf, InvertThePivots) {
  const Links links = linked(GetParam());
  const Pivots pivots = pivots_of(links);
  for (std::size_t i = 0; i < pivots.whole.size(); ++i) {
    const Block error = inverse_of(links.view().pivots[i]) * pivots.whole[i] - Block::Identity();
    // The condition number of a block is some hundreds.
    ASSERT_LE(largest_entry(error), 1e-3) << i;
  }
}

// begin() solves (P + L) r = right; z = P r.
TEST_P(LinkBlocksOf, BeginWithEveryLink) {
  const Links links = linked(GetParam());
  const std::size_t count = links.system().particles.count();
  const LinkSystem system = links.view();
  const Pivots pivots = pivots_of(links);
  const auto right = random_rows(count, 12);
  SolverStorage rows(count);
  rows.of[0] = right;
  Team alone;
  const double begun = links.kernels().begin(system, rows.view(), alone);
  double squared = 0;
  std::vector<MotionRow> earlier(count);
  const auto check = [&](std::uint32_t l) {
    const LinkLevel& level = system.levels[l];
    for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) earlier[i] = rows.of[1][i];
    const std::vector<MotionRow> pulled = product(links, earlier);
    for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) {
      const Eigen::Vector<double, 6> r = entries(rows.of[1][i])(of_a_motion);
      Eigen::Vector<double, 6> left = entries(pulled[i])(of_a_motion);
      left.head<3>() -= pivots.squeezing[i] * r.head<3>();
      ASSERT_LE(largest_entry(left - entries(right[i])(of_a_motion)), 1e-4) << i;
      squared += r.dot(pivots.whole[i] * r);
    }
  };
  for (const LinkBlock& block : links.order().blocks()) {
    for (std::uint32_t l = block.levels_begin; l < block.boundary_begin; ++l) check(l);
  }
  for (std::uint32_t l = 0; l < system.boundary_levels; ++l) {
    for (const LinkBlock& block : links.order().blocks()) check(block.boundary_begin + l);
  }
  EXPECT_NEAR(begun / squared, 1, 1e-4);
}

TEST_P(LinkBlocksOf, SolveTheSystem) {
  const Links links = linked(GetParam());
  const std::size_t count = links.system().particles.count();
  const auto right = random_rows(count, 12);
  SolverStorage rows(count);
  rows.of[0] = right;
  Team alone;
  constexpr double smaller = 1e-5;
  const double begun = links.kernels().begin(links.view(), rows.view(), alone);
  const SolverReport report =
      links.kernels().solve(links.view(), rows.view(), begun, smaller * smaller * begun, 1000, alone);
  EXPECT_LE(report.squared_residual, smaller * smaller * begun);
  EXPECT_LT(report.iterations, 200);
  // The remaining r.C^-1 r, from another begin().
  SolverStorage rest(count);
  const std::vector<MotionRow> solved = product(links, rows.of[0]);
  for (std::size_t i = 0; i < count; ++i) rest.of[0][i].v = right[i].v - solved[i].v;
  EXPECT_LT(links.kernels().begin(links.view(), rest.view(), alone), 4 * smaller * smaller * begun);
}

}  // namespace
}  // namespace peclet::engine
