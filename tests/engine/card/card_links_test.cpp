// The links of a card are the derivative of its loads, and its product is that of the processor.
#include <gtest/gtest.h>

#include <limits>

#include "engine/card/card_pairs.h"
#include "tests/engine/kernels/linked_suspension.h"

namespace peclet::engine {
namespace {

constexpr Terms with_rolling =
    card_variant(CardVariant{CardVariant::Springs::sliding_and_rolling, false, false}.number()).terms();
const Terms rough = {.lubrication = true,
                     .contact = true,
                     .damping = true,
                     .friction = true,
                     .rolling = true,
                     .conservative = true,
                     .kinetic = true};

// Returns a level whose every field is that of `weights` in linked_suspension.h.
CardLevel level_of(const Physics& physics, StepResistance::Part part = StepResistance::Part::whole) {
  CardLevel level{};
  level.timestep = step;
  for (PairParameters& field : level.field) {
    field = card_parameters(physics, step);
    field.approach_time = weights.normal_time;
    field.step_resistance = {part, step};
  }
  return level;
}

// The pairs of a suspension and the kernels that work on them.
template <Terms compiled>
struct Suspension {
  explicit Suspension(const Physics& physics)
      : system(dense_suspension(physics, 203, 7)), pairs(physics, system.particles, system.list, system.box) {
    pairs.set_springs(system.springs);
  }

  System system;
  CardPairs pairs;
  CardTeam team{};
  CardForces<compiled> forces{pairs.scene(), pairs.own(), pairs.progress(), team};
};

// Changes of the motion of spheres.
struct Changes {
  explicit Changes(std::size_t count) : velocity(count), spin(count) {
    Draws draws(11);
    for (std::size_t i = 0; i < count; ++i) {
      velocity[i] = draws.vector();
      spin[i] = draws.vector();
    }
  }
  std::vector<Vector3> velocity, spin;
};

// Appends a force and its torques.
void append(std::vector<double>& numbers, const Vector3& force, const Vector3& first, const Vector3& second) {
  for (const Vector3& v : {force, first, second}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
}

// Expects the links to be the derivative of the loads at forces `approach_time` ahead, apart from forces
// along the normal if `across_normals`.
template <Terms compiled>
void expect_derivative(const Physics& physics, double approach_time, bool across_normals) {
  Suspension<compiled> of(physics);
  CardLevel level = level_of(physics);
  level.field[0].approach_time = approach_time;
  const CardRealisation& own = of.pairs.own();
  const std::size_t pairs = of.pairs.progress().pairs, count = of.system.particles.count();
  const Changes change(count);
  of.forces.assemble(of.pairs.template moment<compiled>(level), CardField::whole);
  const auto normal_of = [&](std::size_t p) {
    const float* const n = own.link[p].normal;
    return Vector3{n[0], n[1], n[2]};
  };
  const auto compared = [&](const Vector3& force, std::size_t p) {
    return across_normals ? across(force, normal_of(p)) : force;
  };
  // Returns the loads at the motion plus `scale` times the change.
  const auto loads = [&](double scale) {
    std::vector<CardRow> velocity(count), spin(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 v = of.system.particles.velocity[i] + scale * change.velocity[i];
      const Vector3 w = of.system.particles.angular_velocity[i] + scale * change.spin[i];
      velocity[i] = {v.x, v.y, v.z, 0};
      spin[i] = {w.x, w.y, w.z, 0};
    }
    auto moment = of.pairs.template moment<compiled>(level);
    moment.velocity = velocity.data();
    moment.spin = spin.data();
    of.forces.evaluate(moment, CardField::whole);
    const auto vector = [](const CardRow& row) { return Vector3{row.x, row.y, row.z}; };
    std::vector<double> numbers;
    for (std::size_t p = 0; p < pairs; ++p) {
      append(numbers, compared(vector(own.pair_force[p]), p), vector(own.torque_first[p]),
             vector(own.torque_second[p]));
    }
    return numbers;
  };
  constexpr double small = 1e-6;
  std::vector<double> expected = loads(small), found;
  const std::vector<double> before = loads(-small);
  for (std::size_t k = 0; k < expected.size(); ++k)
    expected[k] = step * (expected[k] - before[k]) / (2 * small);

  std::size_t linked = 0;
  for (std::size_t p = 0; p < pairs; ++p) {
    const CardLink& link = own.link[p];
    linked += link.squeeze > 0 ? 1 : 0;
    PairGeometry pair{};
    pair.normal = normal_of(p);
    const PairResistance coupling = {link.squeeze,       link.shear,         link.pump_first,
                                     link.pump_second,   own.twist[p].first, link.twist_cross,
                                     own.twist[p].second};
    const std::uint32_t i = own.pair[p].first, j = own.pair[p].second;
    const PairLoad load = lubrication_load(
        coupling, pair, PairMotion{change.velocity[j] - change.velocity[i], change.spin[i], change.spin[j]});
    append(found, compared(load.force, p), load.torque_first, load.torque_second);
  }
  EXPECT_GT(linked, 400u);
  expect_near(expected, found, across_normals ? "across normals" : "all", 1e-6);
}

TEST(CardLinks, AreTheDerivativeOfTheLoads) {
  constexpr Terms smooth =
      card_variant(CardVariant{CardVariant::Springs::none, false, false}.number()).terms();
  expect_derivative<smooth>(
      physics_with({.lubrication = true, .contact = true, .damping = true, .conservative = true}),
      weights.normal_time, false);
  // Springs that never slide, because the stiffness of others is a secant. At a fixed distance, because links
  // leave out how the levers of friction change with it.
  Physics physics = physics_with(rough);
  physics.contact->friction = physics.contact->rolling_friction = 1e6;
  physics.contact->kinetic_friction = std::numeric_limits<double>::infinity();
  expect_derivative<with_rolling>(physics, 0, true);
}

// Coefficients of a link seen from its first particle.
using Numbers = std::array<float, 10>;

// Returns the links of the processor by the rows of their particles, in both orders.
std::map<std::pair<std::uint32_t, std::uint32_t>, Numbers> links_by_rows(const Links& links) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Numbers> found;
  for (const LinkGroup& g : groups_in_order(links.view())) {
    for (int k = 0; k < links_per_group; ++k) {
      if (!(g.squeeze[k] > 0)) continue;
      const float x = g.normal[0][k], y = g.normal[1][k], z = g.normal[2][k];
      const auto i = g.first[k], j = g.second[k];
      found[{i, j}] = {x,
                       y,
                       z,
                       g.squeeze[k],
                       g.shear[k],
                       g.pump_first[k],
                       g.pump_second[k],
                       g.twist_first[k],
                       g.twist_cross[k],
                       g.twist_second[k]};
      found[{j, i}] = {-x,
                       -y,
                       -z,
                       g.squeeze[k],
                       g.shear[k],
                       g.pump_second[k],
                       g.pump_first[k],
                       g.twist_second[k],
                       g.twist_cross[k],
                       g.twist_first[k]};
    }
  }
  return found;
}

TEST(CardLinks, AreThoseOfTheProcessor) {
  using Part = StepResistance::Part;
  for (const Part part : {Part::whole, Part::at_beginning, Part::ahead, Part::on_the_way}) {
    const Physics physics = physics_with(rough);
    Suspension<with_rolling> of(physics);
    of.forces.assemble(of.pairs.moment<with_rolling>(level_of(physics, part)), CardField::whole);
    const Links links(physics, of.system, InstructionSet::baseline, weights, part);
    const auto expected = links_by_rows(links);
    const CardRealisation& own = of.pairs.own();
    std::size_t linked = 0;
    for (std::size_t p = 0; p < of.pairs.progress().pairs; ++p) {
      const CardLink& link = own.link[p];
      if (!(link.squeeze > 0)) continue;
      ++linked;
      const auto& row = links.order().row();
      const auto there = expected.find({row[own.pair[p].first], row[own.pair[p].second]});
      ASSERT_NE(there, expected.end()) << p;
      const Numbers numbers = {link.normal[0],   link.normal[1],     link.normal[2],   link.squeeze,
                               link.shear,       link.pump_first,    link.pump_second, own.twist[p].first,
                               link.twist_cross, own.twist[p].second};
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        const double scale = k < 3 ? 1 : static_cast<double>(link.squeeze);
        EXPECT_NEAR(numbers[k], there->second[k], 1e-6 * scale) << p << ' ' << k;
      }
    }
    EXPECT_EQ(2 * linked, expected.size());
    EXPECT_GT(linked, 400u);
  }
}

TEST(CardSolver, MultipliesAsTheProcessor) {
  const Physics physics = physics_with(rough);
  Suspension<with_rolling> of(physics);
  of.forces.assemble(of.pairs.moment<with_rolling>(level_of(physics)), CardField::whole);
  const CardRealisation& own = of.pairs.own();
  const CardSolver solver(of.pairs.scene(), own, of.team);
  constexpr double without_drag = 0;
  solver.prepare(step, without_drag);

  const std::size_t count = of.system.particles.count();
  const std::vector<MotionRow> right = random_rows(count, 11);
  std::vector<CardMotion> residual(count), scaled(count);
  std::vector<MotionRow> vector(count), product(count);
  const auto row_of = [](const CardMotion& m) {
    const float *const v = m.velocity, *const w = m.spin;
    return MotionRow{Floats{v[0], v[1], v[2], 0, w[0], w[1], w[2], 0}};
  };
  for (std::uint32_t place = 0; place < count; ++place) {
    const std::uint32_t i = own.order[place];
    const Floats& r = right[i].v;
    residual[i] = {{r[0], r[1], r[2]}, {r[4], r[5], r[6]}, {}};
    scaled[i] = solver.over_block(place, residual[i]);
    vector[i] = row_of(scaled[i]);
  }
  const CardSolver::Couplings rows = {own.end_begin, own.linked_count, own.linked_end, own.link,
                                      scaled.data()};
  for (std::uint32_t i = 0; i < count; ++i)
    product[i] = row_of(CardSolver::product_of_row(rows, i, residual[i]));
  const Links links(physics, of.system, InstructionSet::baseline);
  expect_near(numbers(links.times(vector)), numbers(product), "A u", 1e-5);
}

}  // namespace
}  // namespace peclet::engine
