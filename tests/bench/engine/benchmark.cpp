#include "tests/bench/engine/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "contract/provenance.h"
#include "engine/realisation/simulation.h"
#include "tests/bench/engine/catalogue.h"
#include "tests/bench/engine/machine.h"
#include "tests/bench/engine/operations.h"
#include "tests/bench/engine/solver_cost.h"
#include "tests/bench/engine/tiling.h"

namespace peclet::engine {
namespace {

// Work of a contestant per round: long for the clock's resolution, short between disturbances.
constexpr std::size_t particle_steps_per_round = 100000;
// An implicit step costs tens of explicit ones.
constexpr std::size_t implicit_particle_steps_per_round = 10000;
// The strain in which contacts of the packing are replaced by those of the flow.
constexpr double warm_up_strain = 0.2;

void advance(Simulation& simulation, std::uint64_t steps) {
  if (const std::optional<Ending> ending = simulation.advance(steps)) {
    throw std::runtime_error("a case broke off: " + ending->message);
  }
}

// Packs and shears; returns the steps per rebuild of the neighbour list in the second half of the warm-up.
double warm_up(Simulation& simulation, const Scene& scene) {
  const auto half = static_cast<std::uint64_t>(0.5 * warm_up_strain / scene.physics.flow.rate() /
                                               simulation.schedule().timestep);
  simulation.start();
  advance(simulation, half);
  const std::uint64_t builds = simulation.system().list.builds();
  advance(simulation, half);
  const auto rebuilds = static_cast<double>(simulation.system().list.builds() - builds);
  return static_cast<double>(half) / std::max(1.0, rebuilds);
}

// A system after the warm-up, and the steps between rebuilds of its list.
struct Warm {
  System system;
  double steps_per_rebuild;
};

const Warm& warmed_up(const Contestant& contestant) {
  static std::map<std::string, Warm> known;
  const Scene& scene = contestant.scene;
  const std::string key = scene.document.dump();
  if (!known.contains(key)) {
    Simulation simulation(scene, make_schedule(scene, contestant.name), 0, 1, contestant.name);
    const double steps_per_rebuild = warm_up(simulation, scene);
    known[key] = {simulation.system(), steps_per_rebuild};
  }
  return known.at(key);
}

double near_pairs_of(const System& system, const std::vector<PairKind>& kinds) {
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  std::size_t near = 0;
  for (const Pair& pair : system.list.pairs()) {
    near += norm(separation(system.particles, pair, frames[pair.image])) <= kinds[pair.kind].range ? 1 : 0;
  }
  return static_cast<double>(near);
}

class Runner {
 public:
  Runner(const Contestant& contestant, bool wall) : contestant_(contestant), wall_(wall) {
    Scene scene = contestant.scene;
    const auto tiles = static_cast<std::size_t>(contestant.tiles);
    scene.particles.count *= tiles * tiles * tiles;
    simulation_ = std::make_unique<Simulation>(scene, make_schedule(scene, contestant.name), 0,
                                               contestant.threads, contestant.name);
    if (is_implicit()) {
      // Contacts without their springs would be pushed beyond Coulomb's limit, and steps divided.
      steps_per_rebuild_ = warm_up(*simulation_, scene);
      return;
    }
    const Warm& warm = warmed_up(contestant);
    simulation_->start(contestant.tiles == 1 ? warm.system : tiled(warm.system, contestant.tiles));
    steps_per_rebuild_ = warm.steps_per_rebuild;
  }

  // Returns nanoseconds per particle and step. Returns nothing if the list of explicit steps was rebuilt
  // meanwhile; with implicit steps rebuilds are part of every round.
  std::optional<double> measure() {
    const std::size_t all = is_implicit() ? implicit_particle_steps_per_round : particle_steps_per_round;
    const std::uint64_t steps = std::max<std::uint64_t>(10, all / count());
    const std::uint64_t builds = simulation_->system().list.builds();
    const double start = seconds(wall_);
    advance(*simulation_, steps);
    const double taken = seconds(wall_) - start;
    if (simulation_->system().list.builds() != builds && !is_implicit()) return std::nullopt;
    return 1e9 * taken / static_cast<double>(steps * count());
  }

  // Returns nanoseconds per particle of one rebuild.
  double measure_rebuild() const {
    std::vector<double> times;
    for (int r = 0; r < 5; ++r) {
      System copy = simulation_->system();
      const double start = seconds(wall_);
      rebuild_neighbours(copy, contestant_.threads);
      times.push_back(1e9 * (seconds(wall_) - start) / static_cast<double>(count()));
    }
    return spread_of(times).median;
  }

  const Contestant& contestant() const { return contestant_; }
  bool is_implicit() const { return contestant_.scene.method == Method::implicit_steps; }
  std::size_t count() const { return simulation_->system().particles.count(); }
  double steps_per_rebuild() const { return steps_per_rebuild_; }
  // Returns the solver's iterations since the start.
  std::uint64_t iterations() const { return simulation_->step_errors().solver_iterations; }
  const System& system() const { return simulation_->system(); }
  double timestep() const { return simulation_->schedule().timestep; }

 private:
  Contestant contestant_;
  bool wall_;
  std::unique_ptr<Simulation> simulation_;
  double steps_per_rebuild_;
};

struct Measured {
  Spread nanoseconds;             // per particle and step, rebuilds included in proportion
  Spread ratio;                   // over the first contestant of the same round
  double near, listed, crossing;  // pairs per particle
  double rebuild;                 // nanoseconds per particle
  double iterations;              // of the solver per step
};

std::vector<Measured> measure(std::vector<Runner>& runners, int rounds) {
  std::vector<Measured> results;
  std::vector<double> rebuild_share;
  std::vector<std::uint64_t> iterations, steps;
  for (const Runner& runner : runners) {
    const System& system = runner.system();
    const auto count = static_cast<double>(runner.count());
    const std::vector<PairKind> kinds =
        make_pair_kinds(runner.contestant().scene.physics, distinct_radii(system.particles.radius));
    Measured result{};
    result.near = near_pairs_of(system, kinds) / count;
    result.listed = static_cast<double>(system.list.pairs().size()) / count;
    result.crossing = static_cast<double>(system.list.crossings()) / count;
    result.rebuild = runner.measure_rebuild();
    rebuild_share.push_back(runner.is_implicit() ? 0 : result.rebuild / runner.steps_per_rebuild());
    results.push_back(result);
    iterations.push_back(runner.iterations());
    steps.push_back(system.step);
  }
  std::vector<std::vector<double>> times(runners.size()), ratios(runners.size());
  for (int r = 0; r < rounds; ++r) {
    std::optional<double> first;
    for (std::size_t k = 0; k < runners.size(); ++k) {
      std::optional<double> time = runners[k].measure();
      if (time) {
        *time += rebuild_share[k];
        times[k].push_back(*time);
      }
      first = k == 0 ? time : first;
      if (time && first) ratios[k].push_back(*time / *first);
    }
  }
  for (std::size_t k = 0; k < runners.size(); ++k) {
    if (times[k].empty() || ratios[k].empty()) {
      throw std::runtime_error(
          "a list of neighbours was rebuilt in every round: nothing is known of one step");
    }
    results[k].nanoseconds = spread_of(times[k]);
    results[k].ratio = spread_of(ratios[k]);
    results[k].iterations = static_cast<double>(runners[k].iterations() - iterations[k]) /
                            static_cast<double>(runners[k].system().step - steps[k]);
  }
  return results;
}

std::string text(const Spread& spread, int digits) {
  return fmt::format("{:>8.{}f} {:>8.{}f} .. {:<8.{}f}", spread.median, digits, spread.smallest, digits,
                     spread.largest, digits);
}

void print_times(const std::vector<Runner>& runners, const std::vector<Measured>& results) {
  fmt::print("{:<19} {:>7}  {:^28}  {:^28}  {:>5} {:>6} {:>6}  {:>6} {:>7} {:>10}\n", "", "",
             "ns per particle and step", "over the first, same round", "near", "listed", "cross", "steps/",
             "rebuild", "iterations");
  fmt::print("{:<19} {:>7}  {:>8} {:<19}  {:>8} {:<19}  {:>5} {:>6} {:>6}  {:>6} {:>7} {:>10}  {}\n", "case",
             "N", "median", "smallest .. largest", "median", "smallest .. largest", "per N", "per N", "per N",
             "build", "ns", "a step", "what it is");
  for (std::size_t k = 0; k < runners.size(); ++k) {
    const Measured& m = results[k];
    fmt::print("{:<19} {:>7}  {:<28}  {:<28}  {:>5.2f} {:>6.2f} {:>6.2f}  {:>6.0f} {:>7.0f} {:>10}  {}\n",
               runners[k].contestant().name, runners[k].count(), text(m.nanoseconds, 1), text(m.ratio, 3),
               m.near, m.listed, m.crossing, runners[k].steps_per_rebuild(), m.rebuild,
               runners[k].is_implicit() ? fmt::format("{:.1f}", m.iterations) : "",
               runners[k].contestant().meaning);
  }
}

// Lower bounds of a step by the machine's measured rates, per particle.
struct Roof {
  double arithmetic, memory;  // ns
};

// A logarithm or exponential costs a quotient and a polynomial of about ten products and sums.
constexpr double polynomial = 20;

Roof roof_of(const Operations& done, double bytes, const Machine& machine, double count) {
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  const double functions = number(done.logarithms + done.exponentials);
  const double plain = number(done.sums + done.products) + polynomial * functions;
  const double slow =
      (number(done.quotients) + functions) / machine.quotients + number(done.roots) / machine.roots;
  return {1e9 * std::max(plain / machine.products_and_sums, slow) / count, 1e9 * bytes / machine.bytes};
}

void print_roofline(const std::vector<Runner>& runners, const std::vector<Measured>& results,
                    const Machine& machine) {
  fmt::print("\n{:<19} {:^33}  {:>9} {:>7}  {:^24} {:>7} {:>8}\n", "", "per near pair", "1e6 near", "Gflop",
             "ns that the machine needs", "bytes", "");
  fmt::print("{:<19} {:>5} {:>8} {:>4} {:>5} {:>4}   {:>9} {:>7}  {:>12} {:>12} {:>7}\n", "case", "flops",
             "quotients", "roots", "logs", "ns", "pairs / s", "per s", "arithmetic", "memory", "per N");
  for (std::size_t k = 0; k < runners.size(); ++k) {
    const Runner& runner = runners[k];
    const Physics& physics = runner.contestant().scene.physics;
    const std::optional<Operations> done = count_operations(physics, runner.system(), runner.timestep());
    if (!done) continue;
    const auto count = static_cast<double>(runner.count());
    const double pairs = results[k].near * count;
    const double bytes = bytes_per_particle(physics, runner.system(), runner.contestant().threads);
    const Roof roof = roof_of(*done, bytes, machine, count);
    const double each = results[k].nanoseconds.median / results[k].near;
    const auto per_pair = [&](std::uint64_t n) { return static_cast<double>(n) / pairs; };
    const double flops = per_pair(done->sums + done->products);
    fmt::print(
        "{:<19} {:>5.0f} {:>9.2f} {:>5.2f} {:>5.2f} {:>5.1f}  {:>9.1f} {:>7.2f}  {:>12.1f} {:>12.1f} "
        "{:>7.0f}\n",
        runner.contestant().name, flops, per_pair(done->quotients), per_pair(done->roots),
        per_pair(done->logarithms), each, 1e3 / each, flops / each, roof.arithmetic, roof.memory, bytes);
  }
}

void run(const Group& group, const Machine& machine) {
  const bool wall = std::any_of(group.contestants.begin(), group.contestants.end(),
                                [](const Contestant& each) { return each.threads > 1; });
  std::vector<Runner> runners;
  for (const Contestant& contestant : group.contestants) runners.emplace_back(contestant, wall);
  const std::vector<Measured> results = measure(runners, group.rounds);
  fmt::print("\n{}: {}{} {} rounds\n\n", group.name, group.question, wall ? " (time on the wall)" : "",
             group.rounds);
  print_times(runners, results);
  // All contestants of a group have steps of one kind.
  if (!runners.front().is_implicit()) {
    print_roofline(runners, results, machine);
  } else {
    std::vector<std::string> names;
    std::vector<SolverCost> costs;
    for (const Runner& runner : runners) {
      names.push_back(runner.contestant().name);
      costs.push_back(solver_cost(runner.contestant().scene, runner.system(), runner.timestep()));
    }
    print_solvers(names, costs, machine);
  }
  std::fflush(stdout);
}

}  // namespace

void run_benchmarks(const std::vector<std::string>& names) {
  const std::vector<Group> groups = chosen_groups(names);
  const InstructionSet set = chosen_instruction_set();
  const Machine machine = measure_machine(set);
  const Json& build = provenance();
  fmt::print("engine {}  commit {}{}  {}  {}\n", version(), build.at("git_commit").get<std::string>(),
             build.at("git_dirty").get<bool>() ? " with changes" : "", build.at("cpu").get<std::string>(),
             name_of(set));
  fmt::print(
      "one thread of this machine: {:.1f} Gflop/s, {:.2f} quotients, {:.2f} roots per ns, {:.1f} GB/s;\n"
      "{:.1f} Gflop/s of single precision\n",
      1e-9 * machine.products_and_sums, 1e-9 * machine.quotients, 1e-9 * machine.roots, 1e-9 * machine.bytes,
      1e-9 * machine.single_products_and_sums);
  fmt::print("rounds of {} particle steps, implicit ones of {}, after a strain of {}\n",
             particle_steps_per_round, implicit_particle_steps_per_round, warm_up_strain);
  std::fflush(stdout);
  for (const Group& group : groups) run(group, machine);
}

}  // namespace peclet::engine
