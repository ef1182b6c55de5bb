// Holds the card of this machine against its emulation and against the processor, and times it. Prints
// tables.
//
//   card_check [SECONDS [LARGEST]]      SECONDS of each measurement; LARGEST number of spheres
//   card_check errors [SEEDS]           needs no card: errors of the solvers of processor and card, N = 1000
//
// CARD_PROGRAMS names a folder of PTX, 0.ptx and so on, to use in the place of that of this build. Exits with
// 1 if the card is wrong.
#include <fmt/format.h>
#include <omp.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/sha256.h"
#include "engine/card/card_ptx.h"
#include "engine/card/cuda_driver.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/card_ensemble.h"
#include "engine/realisation/schedule.h"

namespace {

using namespace peclet;
using namespace peclet::engine;
using Simulations = std::vector<std::unique_ptr<Simulation>>;
using WallClock = std::chrono::steady_clock;

double since(WallClock::time_point begin) {
  return std::chrono::duration<double>(WallClock::now() - begin).count();
}

struct NamedScene {
  const char* name;
  const char* own;  // keys beside those of all scenes
};
constexpr NamedScene scenes[] = {
    {"no friction", R"({"flow": {"shear_rate": 0.009}})"},
    {"friction 1", R"({"flow": {"shear_rate": 0.009}, "contact": {"friction": 1}})"},
    {"Pe 1", R"({"peclet": 1, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}})"},
    {"Pe 100", R"({"peclet": 100, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017}})"},
    {"rolling", R"({"peclet": 100, "limits": {"shear_rate": 0.009, "thermal_energy": 0.017},
        "contact": {"friction": 0.5, "rolling_stiffness": 3e3, "rolling_friction": 0.1},
        "repulsion": {"form": "exponential", "strength": 1.7e-3}, "attraction": {"hamaker": 1e-3, "cutoff": 0.1}})"},
    {"mari", R"({"flow": {"shear_rate": 0.009}, "contact": {"friction": 0.5},
        "lubrication": {"form": "mari", "inner_gap": null, "outer_gap": null, "regularisation": 1e-3,
                        "outer_distance": 0.5}})"}};
constexpr std::size_t timed_scenes = 4;  // the first ones

Json document(const NamedScene& named, std::size_t count) {
  Json scene = Json::parse(R"({
    "particles": {"density": 0.1,
                  "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}]},
    "volume_fraction": 0.5, "fluid": {"viscosity": 0.1}, "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 0.2}, "production": {"strain": 1000}}})");
  scene["particles"]["count"] = count;
  scene.merge_patch(Json::parse(named.own));
  return scene;
}

struct Case {
  explicit Case(const Json& document)
      : scene(read_scene(document, "scene")), schedule(make_schedule(scene, "scene")) {}

  Simulations started(std::size_t seeds) const {
    Simulations all(seeds);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t s = 0; s < seeds; ++s) {
      all[s] = std::make_unique<Simulation>(scene, schedule, s, 1, "scene");
      all[s]->start();
    }
    return all;
  }

  Scene scene;
  Schedule schedule;
};

std::string programs() {
  const char* const folder = std::getenv("CARD_PROGRAMS");
  return folder == nullptr ? "" : folder;
}

std::string hash_of(const System& system) {
  ArchiveWriter state;
  save(system, state);
  return sha256(state.bytes()).substr(0, 12);
}

// Advances seeds by `steps` steps.
Simulations advanced(const Case& of, std::size_t seeds, std::uint64_t steps,
                     std::unique_ptr<CardDevice> device) {
  Simulations all = of.started(seeds);
  CardEnsemble ensemble(std::move(device));
  for (const auto& simulation : all) ensemble.add(*simulation);
  ensemble.limit_steps(steps);
  ensemble.advance(std::chrono::duration<double>(60));
  for (const auto& simulation : all) ensemble.remove(*simulation);
  return all;
}

// Returns the difference of velocities over the velocities relative to the flow.
double difference(const System& a, const System& b) {
  double speed = 0, apart = 0;
  for (std::size_t i = 0; i < a.particles.count(); ++i) {
    const Vector3 v = a.particles.velocity[i], u = v - a.box.velocity_gradient() * a.particles.position[i],
                  d = v - b.particles.velocity[i];
    speed += dot(u, u);
    apart += dot(d, d);
  }
  return std::sqrt(apart / speed);
}

// Prints what the driver's compiler makes of each variant.
void list_variants() {
  const Card card;
  fmt::print("{}, compute capability {}, {} multiprocessors, {} MiB of second-level cache; PTX {}\n",
             card.name(), card.compute_capability(), card.multiprocessors(), card.l2_size() >> 20,
             card_ptx_sha256().substr(0, 12));
  fmt::print("{:>7} {:>9} {:>9} {:>8} {:>8}\n", "variant", "compile/s", "registers", "local/B", "shared/B");
  for (unsigned variant = 0; variant < count_of_card_variants; ++variant) {
    const WallClock::time_point begin = WallClock::now();
    const CardModule module(card_ptx(variant));
    const CardKernel kernel = module.kernel("advance");
    fmt::print("{:>7} {:>9.2f} {:>9} {:>8} {:>8}\n", variant, since(begin), kernel.registers(),
               kernel.local_bytes(), kernel.shared_bytes());
  }
}

// Returns true if faults are reported: PTX that does not compile, a kernel that is not there, a range that is
// too large.
bool sees_faults() {
  const Card card;
  const auto is_seen = [](auto&& fault) {
    try {
      fault();
    } catch (const CardError&) {
      return true;
    }
    return false;
  };
  return is_seen([] {
           const CardModule wrong(
               ".version 7.5\n.target sm_80\n.address_size 64\n.entry advance() { nonsense; }\n");
         }) &&
         is_seen([] { CardModule(card_ptx(0)).kernel("retreat"); }) && is_seen([] {
           CardMemory(8).upload(std::vector{1.0, 2.0});
         });
}

// Compares eight steps with a tight tolerance. Returns false if the card is wrong.
bool compare() {
  constexpr std::size_t seeds = 3, spheres = 150;
  constexpr std::uint64_t steps = 8;
  constexpr double tolerance = 1e-6, much = 1e-4;
  bool is_right = true;
  fmt::print("{} steps at a tolerance of {:g}: velocities beside the processor's, and the state's hash\n",
             steps, tolerance);
  fmt::print("{:12} {:>5} {:>10}  {:12}  {:12}\n", "scene", "seed", "difference", "card", "emulation");
  for (const NamedScene& named : scenes) {
    Json scene = document(named, spheres);
    scene["integrator"]["tolerance"] = tolerance;
    const Case of(scene);
    const Simulations on_card = advanced(of, seeds, steps, cuda_card(0, programs()));
    const Simulations emulated = advanced(of, seeds, steps, emulated_card(seeds));
    for (std::size_t s = 0; s < seeds; ++s) {
      Simulation processor(of.scene, of.schedule, s, 1, "scene");
      processor.start();
      processor.advance(steps);
      const double apart = difference(processor.system(), on_card[s]->system());
      const std::string card = hash_of(on_card[s]->system()), emulation = hash_of(emulated[s]->system());
      const bool good = apart < much && card == emulation;
      is_right = is_right && good;
      fmt::print("{:12} {:>5} {:>10.1e}  {:12}  {:12}{}\n", named.name, s, apart, card, emulation,
                 good ? "" : "  WRONG");
    }
  }
  return is_right;
}

// Prints iterations of one step from the same states, and errors of its velocities, beside a tight tolerance.
void compare_solvers(std::size_t seeds) {
  constexpr std::size_t spheres = 1000;
  constexpr std::uint64_t steps_before = 100;
  constexpr double tight = 1e-7;
  fmt::print("one step at the default tolerance, N = {}, {} states: iterations, and errors of velocities\n",
             spheres, seeds);
  fmt::print("{:12} {:>9} {:>9} {:>5} {:>9} {:>9} {:>5}\n", "scene", "processor", "card", "ratio",
             "processor", "card", "ratio");
  for (std::size_t k = 0; k < timed_scenes; ++k) {
    Json json = document(scenes[k], spheres);
    json["duration"]["equilibration"]["strain"] = 0.02;  // iterations are counted in the production window
    const Case usual(json);
    json["integrator"]["tolerance"] = tight;
    const Case exact(json);
    const Simulations states = usual.started(seeds);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t s = 0; s < seeds; ++s) states[s]->advance(steps_before);
    const auto from_states = [&](const Case& of) {
      Simulations all(seeds);
      for (std::size_t s = 0; s < seeds; ++s) {
        all[s] = std::make_unique<Simulation>(of.scene, of.schedule, s, 1, "scene");
        all[s]->start(states[s]->system());
      }
      return all;
    };
    const Simulations reference = from_states(exact), processor = from_states(usual),
                      card = from_states(usual);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t s = 0; s < seeds; ++s) {
      reference[s]->advance(1);
      processor[s]->advance(1);
    }
    CardEnsemble ensemble(emulated_card(seeds));
    ensemble.limit_steps(1);
    for (const auto& simulation : card) ensemble.add(*simulation);
    ensemble.advance(std::chrono::duration<double>(0));
    for (const auto& simulation : card) ensemble.remove(*simulation);
    std::array<double, 2> iterations{}, errors{};
    for (std::size_t s = 0; s < seeds; ++s) {
      for (const auto& [i, one] : {std::pair(0U, &processor), std::pair(1U, &card)}) {
        iterations.at(i) += static_cast<double>((*one)[s]->step_errors().solver_iterations);
        errors.at(i) += difference(reference[s]->system(), (*one)[s]->system());
      }
    }
    const auto mean = [&](double sum) { return sum / static_cast<double>(seeds); };
    fmt::print("{:12} {:>9.1f} {:>9.1f} {:>5.1f} {:>9.4f} {:>9.4f} {:>5.1f}\n", scenes[k].name,
               mean(iterations[0]), mean(iterations[1]), iterations[1] / iterations[0], mean(errors[0]),
               mean(errors[1]), errors[1] / errors[0]);
  }
}

double per_step(std::uint64_t number, const Simulation& simulation) {
  return static_cast<double>(number) /
         static_cast<double>(std::max<std::uint64_t>(1, sum_of(simulation.production().blocks()).steps));
}

void measure(const NamedScene& named, std::size_t spheres, double seconds) {
  const Case of(document(named, spheres));
  CardEnsemble ensemble(cuda_card(0, programs()));
  const std::size_t seeds = ensemble.capacity(of.scene);
  const Simulations on_card = of.started(seeds);
  for (const auto& simulation : on_card) ensemble.add(*simulation);
  const auto made = [&] {
    std::uint64_t sum = 0;
    for (const auto& simulation : on_card) sum += ensemble.steps_made(*simulation);
    return static_cast<double>(sum);
  };
  const auto run = [&](double time) {
    const WallClock::time_point begin = WallClock::now();
    while (since(begin) < time) ensemble.advance(std::chrono::duration<double>(0.1));
    return since(begin);
  };
  run(2 * seconds);
  const double before = made(), time = run(seconds), card = (made() - before) / time;
  std::string shares;
  double cycles = 0;
  for (const std::uint64_t part : ensemble.progress(*on_card.front()).cycles)
    cycles += static_cast<double>(part);
  for (const std::uint64_t part : ensemble.progress(*on_card.front()).cycles) {
    shares += fmt::format(" {:>3.0f}", 100 * static_cast<double>(part) / cycles);
  }
  for (const auto& simulation : on_card) ensemble.remove(*simulation);

  // The processor goes on from states of the card.
  const auto threads = static_cast<std::size_t>(omp_get_num_procs());
  Simulations on_processor(threads);
  for (std::size_t s = 0; s < threads; ++s) {
    on_processor[s] = std::make_unique<Simulation>(of.scene, of.schedule, s, 1, "scene");
    on_processor[s]->start(on_card[s % seeds]->system());
  }
  std::uint64_t steps = 0;
  const WallClock::time_point begin = WallClock::now();
#pragma omp parallel for schedule(static, 1) reduction(+ : steps)
  for (std::size_t s = 0; s < threads; ++s) {
    const std::uint64_t from = on_processor[s]->system().step;
    while (since(begin) < seconds) on_processor[s]->advance(4);
    steps += on_processor[s]->system().step - from;
  }
  const double processor = static_cast<double>(steps) / since(begin);
  fmt::print("{:12} {:>5} {:>6} {:>9.0f} {:>6.1f} {:>9.0f} {:>6.1f} {:>6.2f} {}\n", named.name, spheres,
             seeds, card, per_step(on_card.front()->step_errors().solver_iterations, *on_card.front()),
             processor,
             per_step(on_processor.front()->step_errors().solver_iterations, *on_processor.front()),
             card / processor, shares);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && argv[1] == std::string_view("errors")) {
    compare_solvers(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 6);
    return 0;
  }
  const double seconds = argc > 1 ? std::atof(argv[1]) : 1;
  const std::size_t largest = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 4000;
  if (const std::optional<std::string> lack = why_no_card()) {
    fmt::print(stderr, "card_check: no card: {}\n", *lack);
    return 1;
  }
  list_variants();
  const bool sees = sees_faults();
  if (!sees) fmt::print("WRONG: a fault is not reported\n");
  const bool is_right = compare() && sees;
  fmt::print(
      "\nrealisation-steps a second of the card, and of {} cores; iterations of a step; shares of the card's "
      "time "
      "[%]: list, assembly, blocks, forces, gathering, residual, solution, stress, rest\n",
      omp_get_num_procs());
  fmt::print("{:12} {:>5} {:>6} {:>9} {:>6} {:>9} {:>6} {:>6}\n", "scene", "N", "places", "card", "", "cores",
             "", "ratio");
  for (const std::size_t spheres : std::initializer_list<std::size_t>{1000, 250, 500, 2000, 4000}) {
    for (std::size_t s = 0; s < timed_scenes && spheres <= largest; ++s) measure(scenes[s], spheres, seconds);
  }
  return is_right ? 0 : 1;
}
