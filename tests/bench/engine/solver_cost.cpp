#include "tests/bench/engine/solver_cost.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <span>

#include "engine/integrators/velocity_solver.h"
#include "tests/bench/engine/counted_links.h"

namespace peclet::engine {
namespace {

constexpr int repetitions = 15;
// Reduction of the squared residual, about ten to forty iterations.
constexpr double taken_away = 1e-8;

double flops(const Operations& done) { return static_cast<double>(done.sums + done.products); }

template <class Work>
double seconds_of(Work&& work) {
  const double start = seconds();
  work();
  return seconds() - start;
}

std::vector<MotionRow> ones(std::size_t count) {
  MotionRow row{};
  row.v += 1.0F;
  row.v[3] = row.v[7] = 0;
  return std::vector<MotionRow>(count, row);
}

// Returns the bytes of an iteration, which loops three times over all rows. Each loop reads and writes the
// following once and finds nothing in a cache; overwritten memory is fetched first.
// - Back through the levels: z, p, t and s; all but z are written. Pivots and links are read.
// - Forward: y and s, which are written, p and t. Pivots and links are read.
// - New solution: x, r, z and s, which are written, t and y.
// Links' accesses to rows of other levels are included; buffers for other blocks are not.
double bytes_of_iteration(std::size_t rows, std::size_t groups) {
  constexpr std::size_t row = sizeof(MotionRow), changed = 2 * row;
  constexpr std::size_t back = row + 3 * changed + sizeof(Pivot);
  constexpr std::size_t forward = 2 * changed + 2 * row + sizeof(Pivot);
  constexpr std::size_t solution = 4 * changed + 2 * row;
  return static_cast<double>(rows * (back + forward + solution) + groups * 2 * sizeof(LinkGroup));
}

std::size_t room_of_iteration(std::size_t rows, std::size_t groups) {
  constexpr std::size_t vectors = 7;
  return rows * (vectors * sizeof(MotionRow) + sizeof(Pivot)) + groups * sizeof(LinkGroup);
}

std::span<const LinkLevel> levels_of(const LinkSystem& system) {
  return {system.levels, system.blocks[system.count_of_blocks - 1].levels_end};
}

std::size_t groups_of_crossing(const LinkLevel& level) {
  return (level.count_of_crossing + links_per_group - 1) / links_per_group;
}

// The system of `system` without its links.
class RowsAlone {
 public:
  explicit RowsAlone(const LinkSystem& system)
      : system_(system), levels_(levels_of(system).begin(), levels_of(system).end()) {
    for (LinkLevel& level : levels_) {
      level.count_of_groups = level.count_of_crossing = 0;
      level.incoming_end = level.incoming_begin;
    }
    system_.levels = levels_.data();
  }
  RowsAlone(const RowsAlone&) = delete;
  RowsAlone& operator=(const RowsAlone&) = delete;

  Operations operations(const std::vector<MotionRow>& right) const {
    return count_solver_operations(system_, right.data(), 1).iteration;
  }

  // Returns the seconds of an iteration.
  double time(const LinkKernels& kernels, const std::vector<MotionRow>& right) const {
    std::array<std::vector<MotionRow>, 7> v;
    v.fill(std::vector<MotionRow>(right.size()));
    const SolverRows rows = {v[0].data(), v[1].data(), v[2].data(), v[3].data(),
                             v[4].data(), v[5].data(), v[6].data()};
    constexpr int few = 3;  // before convergence
    std::vector<double> times(repetitions);
    Team alone;
    for (double& time : times) {
      v[0] = right;
      const double squared = kernels.begin(system_, rows, alone);
      time = -seconds_of([&] { kernels.solve(system_, rows, squared, 0, 0, alone); });
      time += seconds_of([&] { kernels.solve(system_, rows, squared, 0, few, alone); });
      time /= few;
    }
    return spread_of(times).median;
  }

 private:
  LinkSystem system_;
  std::vector<LinkLevel> levels_;
};

double links_in(const LinkGroup* groups, std::size_t count) {
  std::size_t links = 0;
  for (const LinkGroup& group : std::span(groups, count)) {
    for (int k = 0; k < links_per_group; ++k) {
      // Links that pad a group have no normal.
      links += group.normal[0][k] != 0 || group.normal[1][k] != 0 || group.normal[2][k] != 0 ? 1 : 0;
    }
  }
  return static_cast<double>(links);
}

void count(const LinkSystem& system, const std::vector<MotionRow>& right, SolverCost& cost) {
  const SolverOperations all = count_solver_operations(system, right.data(), 1);
  cost.of_rows = RowsAlone(system).operations(right);
  cost.of_links = all.iteration - cost.of_rows;
  cost.of_factorisation = all.factorisation;
  cost.rows = static_cast<double>(system.particles);
  std::size_t groups = 0;
  for (const LinkLevel& level : levels_of(system)) {
    groups += level.count_of_groups + groups_of_crossing(level);
    cost.links += links_in(system.groups + level.groups_begin, level.count_of_groups) +
                  links_in(system.groups + level.crossing_begin, groups_of_crossing(level));
  }
  cost.levels = levels_of(system).size();
  cost.bytes = bytes_of_iteration(system.particles, groups);
  cost.room = room_of_iteration(system.particles, groups);
}

double time_of_factorisation(const LinkSystem& system, const LinkKernels& kernels) {
  std::vector<Pivot> pivots(system.particles);
  LinkSystem with_own_pivots = system;
  with_own_pivots.pivots = pivots.data();
  Team alone;
  std::vector<double> times(repetitions);
  for (double& time : times) {
    time = seconds_of([&] { kernels.factorise(with_own_pivots, pivots.data(), alone); });
  }
  return spread_of(times).median;
}

}  // namespace

SolverCost solver_cost(const Scene& scene, const System& given, double timestep) {
  const InstructionSet set = chosen_instruction_set();
  System system = given;
  const ParticleState& particles = system.particles;
  // Settings at the start of midpoint.h and noisy_midpoint.h.
  const bool noise = scene.physics.thermal_energy > 0;
  const double approach_time = noise ? 0.5 * timestep : 0;
  const auto part = noise ? StepResistance::Part::at_beginning : StepResistance::Part::on_the_way;
  ForceField field(scene.physics, particles, timestep, 0, 1, set, approach_time, part);
  Loads loads(particles.count(), 1);
  {
    System moved = system;  // springs advance
    field.evaluate(moved, loads.force, loads.torque);
  }
  StepOrigin origin;
  origin.mark(system, 1);
  VelocitySolver solver(scene.physics, particles, timestep, scene.solver_tolerance, 1, set);
  solver.assemble(system, field);  // sets the order of rows, which later calls find done
  std::vector<double> assembly, residuals, iteration;
  for (int r = 0; r < repetitions; ++r) {
    assembly.push_back(seconds_of([&] { solver.assemble(system, field); }));
    VelocitySolver::Residual residual{};
    residuals.push_back(seconds_of([&] { residual = solver.set_residual(system, origin, loads, nullptr); }));
    StepReport report;
    const auto correct = [&](double target) {
      return seconds_of([&] {
        if (!solver.correct(system, target, report)) throw std::runtime_error("a case has no solution");
      });
    };
    const double with_iterations = correct(taken_away * residual.squared);
    system.particles.velocity = origin.velocity();
    system.particles.angular_velocity = origin.spin();
    const int iterations = report.solver_iterations;
    solver.set_residual(system, origin, loads, nullptr);
    const double without = correct(std::numeric_limits<double>::infinity());
    iteration.push_back((with_iterations - without) / iterations);
  }
  SolverCost cost{};
  const LinkSystem links = solver.links(system);
  const LinkKernels& kernels = link_kernels(set);
  const std::vector<MotionRow> right = ones(particles.count());
  count(links, right, cost);
  cost.iteration = spread_of(iteration);
  cost.rows_alone = RowsAlone(links).time(kernels, right);
  cost.factorisation = time_of_factorisation(links, kernels);
  cost.assembly = spread_of(assembly).median - cost.factorisation;
  cost.residual = spread_of(residuals).median;
  cost.stream = stream_rate(set, cost.room);
  return cost;
}

void print_solvers(const std::vector<std::string>& names, const std::vector<SolverCost>& costs,
                   const Machine& machine) {
  const auto nanoseconds = [](double seconds, double of) { return 1e9 * seconds / of; };
  const auto arithmetic = [&](double flops) { return flops / machine.single_products_and_sums; };
  fmt::print("\n{:<19} {:^16} {:^12} {:^28} {:>7} {:>7} {:>7} {:>7} {:^25} {:>7} {:>7} {:>7}\n",
             "an iteration", "", "flops", "ns per particle", "rows", "ns", "Gflop", "GB",
             "ns the machine needs", "bytes", "kB", "GB/s");
  fmt::print(
      "{:<19} {:>6} {:>9} {:>6} {:>5} {:>8} {:<19} {:>7} {:>7} {:>7} {:>7} {:>12} {:>12} {:>7} {:>7} {:>7}\n",
      "case", "levels", "links / N", "a link", "a row", "median", "smallest .. largest", "alone", "a link",
      "per s", "per s", "arithmetic", "transfers", "per N", "of room", "in it");
  for (std::size_t k = 0; k < names.size(); ++k) {
    const SolverCost& c = costs[k];
    const double of_links = flops(c.of_links), of_rows = flops(c.of_rows);
    const Spread& t = c.iteration;
    fmt::print(
        "{:<19} {:>6} {:>9.2f} {:>6.0f} {:>5.0f} {:>8.1f} {:>8.1f} .. {:<7.1f} {:>7.1f} {:>7.1f} {:>7.1f} "
        "{:>7.1f} "
        "{:>12.1f} {:>12.1f} {:>7.0f} {:>7.0f} {:>7.0f}\n",
        names[k], c.levels, c.links / c.rows, of_links / c.links, of_rows / c.rows,
        nanoseconds(t.median, c.rows), nanoseconds(t.smallest, c.rows), nanoseconds(t.largest, c.rows),
        nanoseconds(c.rows_alone, c.rows), nanoseconds(t.median, c.links),
        1e-9 * (of_links + of_rows) / t.median, 1e-9 * c.bytes / t.median,
        nanoseconds(arithmetic(of_links + of_rows), c.rows), nanoseconds(c.bytes / c.stream, c.rows),
        c.bytes / c.rows, 1e-3 * static_cast<double>(c.room), 1e-9 * c.stream);
  }
  fmt::print("\n{:<19} {:>9} {:>13} {:>9}  {:^26}\n", "before iterations,", "assembly", "factorisation",
             "residual", "of the factorisation");
  fmt::print("{:<19} {:>9} {:>13} {:>9}  {:>9} {:>16}\n", "ns per particle", "", "", "", "flops / N",
             "needs ns");
  for (std::size_t k = 0; k < names.size(); ++k) {
    const SolverCost& c = costs[k];
    const double work = flops(c.of_factorisation);
    fmt::print("{:<19} {:>9.1f} {:>13.1f} {:>9.1f}  {:>9.0f} {:>16.1f}\n", names[k],
               nanoseconds(c.assembly, c.rows), nanoseconds(c.factorisation, c.rows),
               nanoseconds(c.residual, c.rows), work / c.rows, nanoseconds(arithmetic(work), c.rows));
  }
}

}  // namespace peclet::engine
