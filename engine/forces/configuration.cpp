#include "engine/forces/configuration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

#include "contract/errors.h"
#include "engine/forces/card_pass.h"
#include "engine/kernels/force_field.h"
#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/observables/structure.h"
#include "engine/scene/law_blocks.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

Vector3 vector_from(const Json& array) {
  return {array.at(0).get<double>(), array.at(1).get<double>(), array.at(2).get<double>()};
}

class Reader {
 public:
  Reader(const Json& document, std::string file) : document_(document), file_(std::move(file)) {}

  Configuration read() {
    const Json& state = document_.at("state");
    Configuration configuration;
    configuration.physics = read_physics(document_.at("scene"), file_, "/scene");
    const auto radius = state.at("radius").get<std::vector<double>>();
    check_lubrication(configuration.physics, radius);
    configuration.particles = make_particles(radius, 1);
    ParticleState& particles = configuration.particles;
    particles.position = field("/state/position", radius.size());
    particles.velocity = field("/state/velocity", radius.size());
    particles.angular_velocity = field("/state/angular_velocity", radius.size());
    configuration.box = PeriodicCell(vector_from(state.at("box").at("lengths")),
                                     configuration.physics.flow.deformation().velocity_gradient(0),
                                     state.at("box").at("tilt").get<double>());
    for (std::size_t k = 0; k < state.value("springs", Json::array()).size(); ++k) {
      const std::string at = fmt::format("/state/springs/{}", k);
      const PairName name = pair_name(at, radius.size());
      const double slides = this->at(at).at("slides").get<bool>() ? 1 : 0;
      configuration.springs.push_back({name.first,
                                       name.second,
                                       name.image,
                                       {vector(at + "/tangential"), vector(at + "/rolling"), slides}});
    }
    if (state.contains("noise")) configuration.noise = noise(radius.size());
    if (document_.contains("advance")) configuration.advance = document_.at("advance").get<double>();
    return configuration;
  }

 private:
  struct PairName {
    std::uint32_t first, second;
    LatticeShift image;
  };

  const Json& at(const std::string& pointer) const { return document_.at(Json::json_pointer(pointer)); }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& value,
                           const std::string& allowed) const {
    throw InputError(file_, pointer, value, allowed);
  }

  void check_lubrication(const Physics& physics, const std::vector<double>& radius) const {
    if (!physics.lubrication || radius.empty()) return;
    const std::optional<std::string> fault =
        fault_of_outer_distance(*physics.lubrication, *std::ranges::min_element(radius));
    if (fault) {
      const std::string pointer = "/scene/lubrication/outer_distance";
      refuse(pointer, shortened(at(pointer)), *fault);
    }
  }

  Vector3 vector(const std::string& pointer) const { return vector_from(at(pointer)); }

  VectorField field(const std::string& pointer, std::size_t count) const {
    if (at(pointer).size() != count) {
      refuse(pointer, fmt::format("{} vectors", at(pointer).size()),
             fmt::format("must have {}, as many as radii", count));
    }
    VectorField field(count);
    for (std::size_t i = 0; i < count; ++i) {
      field.set(i, vector(fmt::format("{}/{}", pointer, i)));
    }
    return field;
  }

  PairName pair_name(const std::string& pointer, std::size_t count) const {
    const Json& entry = at(pointer);
    const auto i = entry.at("i").get<std::uint64_t>(), j = entry.at("j").get<std::uint64_t>();
    if (i >= j || j >= count) {
      refuse(pointer + "/j", std::to_string(j), fmt::format("must be above i = {} and below {}", i, count));
    }
    const auto image = entry.at("image").get<std::vector<std::int32_t>>();
    return {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), {image[0], image[1], image[2]}};
  }

  GivenNoise noise(std::size_t count) const {
    GivenNoise noise;
    noise.timestep = at("/state/noise/timestep").get<double>();
    noise.force = field("/state/noise/force", count);
    noise.torque = field("/state/noise/torque", count);
    for (std::size_t k = 0; k < at("/state/noise").value("pairs", Json::array()).size(); ++k) {
      const std::string pointer = fmt::format("/state/noise/pairs/{}", k);
      const PairName name = pair_name(pointer, count);
      noise.pairs.push_back(
          {name.first, name.second, name.image, {vector(pointer + "/theta"), vector(pointer + "/chi")}});
    }
    return noise;
  }

  const Json& document_;
  std::string file_;
};

}  // namespace

const KeyTable& configuration_keys() {
  static const KeyTable table("configuration", fmt::format(R"(
/scene | anything | the blocks {} of a scene
/advance? | number >= 0; in time | time by which the springs are advanced
/state | object | the configuration
/state/box | object | the periodic cell
/state/box/lengths | array of 3; in length | Lx, Ly, Lz
/state/box/lengths/* | number > 0
/state/box/tilt | number; in length; default 0.0 | x component of the second lattice vector
/state/radius | array of 1 or more; in length | radii
/state/radius/* | number > 0
/state/position | array; in length | centres
/state/position/* | array of 3
/state/position/*/* | number
/state/velocity | array; in length / time; as /state/position | velocities in the laboratory frame
/state/angular_velocity | array; in 1 / time; as /state/position | angular velocities
/state/springs? | array | contact springs
/state/springs/* | object
/state/springs/*/i | integer >= 0 | first particle
/state/springs/*/j | integer >= 0 | second particle, above i
/state/springs/*/image | array of 3 | lattice vectors added to the second particle's position as given
/state/springs/*/image/* | integer
/state/springs/*/tangential | array of 3; as /state/position/* | sliding spring
/state/springs/*/rolling | array of 3; as /state/position/* | rolling spring
/state/springs/*/slides | true or false; default false | whether the contact slides, with kinetic friction
/state/noise? | object | random vectors to use
/state/noise/timestep | number > 0; in time | dt of the amplitude sqrt(2 kT / dt)
/state/noise/force | array; as /state/position | normal vectors of the forces
/state/noise/torque | array; as /state/position | normal vectors of the torques
/state/noise/pairs? | array | normal vectors of pairs
/state/noise/pairs/* | object
/state/noise/pairs/*/i | integer >= 0 | first particle
/state/noise/pairs/*/j | integer >= 0 | second particle, above i
/state/noise/pairs/*/image | array of 3; as /state/springs/*/image | lattice vectors added to the second
    particle's position as given
/state/noise/pairs/*/theta | array of 3; as /state/position/* | normal vector of the force and its torques
/state/noise/pairs/*/chi | array of 3; as /state/position/* | normal vector of the other torques
)",
                                                           fmt::join(blocks_of_physics(), ", ")));
  return table;
}

Configuration read_configuration(const Json& document, const std::string& file) {
  return Reader(configuration_keys().validate(document, file), file).read();
}

namespace {

using PairName = std::tuple<std::uint32_t, std::uint32_t, LatticeShift>;

Json to_json(const Vector3& v) { return {v.x, v.y, v.z}; }

Json to_json(const VectorField& field) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < field.size(); ++i) rows.push_back(to_json(field[i]));
  return rows;
}

Json to_json(const SymmetricTensor& t) {
  return {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
}

// ByTerm collects forces, torques and stress of each term that occurs.
class ByTerm {
 public:
  explicit ByTerm(const Configuration& configuration) : configuration_(configuration) {}

  void add_single(const char* term, std::size_t i, const Vector3& force, const Vector3& torque) {
    Sums& sums = of(term);
    sums.force.set(i, sums.force[i] + force);
    sums.torque.set(i, sums.torque[i] + torque);
  }

  void add_stress(const char* term, const SymmetricTensor& stress) { of(term).stress += stress; }

  Json json() const {
    Json answer = {{"force", Json::object()}, {"torque", Json::object()}, {"stress", Json::object()}};
    for (const auto& [term, sums] : sums_) {
      answer["force"][term] = to_json(sums.force);
      answer["torque"][term] = to_json(sums.torque);
      answer["stress"][term] = to_json(sums.stress);
    }
    return answer;
  }

 private:
  struct Sums {
    VectorField force, torque;
    SymmetricTensor stress;
  };

  Sums& of(const char* term) {
    const std::size_t count = configuration_.particles.count();
    return sums_.try_emplace(term, Sums{VectorField(count), VectorField(count), {}}).first->second;
  }

  const Configuration& configuration_;
  std::map<std::string, Sums> sums_;
};

// TermRecipe defines a term: the loads of the pairs `with` it less those `without` it.
struct TermRecipe {
  const char* name;
  Terms with, without;
  Physics physics;
};

// Returns the physics with one conservative law alone.
Physics without_others(Physics physics, StressTerm kept) {
  for_each_conservative_law(
      [&](StressTerm part, auto& law) {
        if (part != kept) law.reset();
      },
      physics);
  return physics;
}

std::vector<TermRecipe> recipes_of(const Physics& physics) {
  std::vector<TermRecipe> recipes;
  const Terms terms = required_terms(physics), touching = {.contact = true};
  const Terms sliding = {.contact = true, .friction = true, .kinetic = terms.kinetic};
  Terms turning = sliding;
  turning.rolling = true;
  const auto add = [&](bool present, const char* name, const Terms& with, const Terms& without) {
    if (present) {
      recipes.push_back({name, with, without, physics});
    }
  };
  const Terms lubricated = {.lubrication = true, .strained = terms.strained};
  const Terms noisy = {.lubrication = true, .noise = true, .strained = terms.strained};
  add(terms.lubrication, "lubrication", lubricated, {});
  add(terms.noise, "brownian_lubrication", noisy, lubricated);
  add(terms.contact, "contact_normal", touching, {});
  if (terms.damping) {
    // Damping would lose digits beside the normal force, which is left out.
    recipes.push_back({"contact_damping", {.contact = true, .damping = true}, touching, physics});
    recipes.back().physics.contact->normal_stiffness = 0;
  }
  add(terms.friction, "friction", sliding, touching);
  add(terms.rolling, "rolling", turning, sliding);
  for_each_conservative_law(
      [&](StressTerm part, const auto& law) {
        if (law)
          recipes.push_back({name_of(part), {.conservative = true}, {}, without_others(physics, part)});
      },
      physics);
  return recipes;
}

// Evaluation answers `peclet-engine forces` with the kernels of the time loop, term by term. The kernels for
// cards compute the pairs if they are asked for; the other terms are those of the baseline then.
class Evaluation {
 public:
  explicit Evaluation(const Configuration& configuration)
      : configuration_(configuration),
        terms_(required_terms(configuration.physics)),
        is_as_card_(emulated_card_is_chosen()),
        set_(is_as_card_ ? InstructionSet::baseline : chosen_instruction_set()),
        by_term_(configuration) {
    const ParticleState& particles = configuration.particles;
    const std::vector<double> sizes = distinct_radii(particles.radius);
    kinds_ = make_pair_kinds(configuration.physics, sizes);
    list_ = NeighbourList(range_table(kinds_, sizes.size()), 0);
    list_.build(particles, configuration.box);
    if (is_as_card_) {
      if (const auto refusal = refusal_by_card(configuration.physics, list_)) throw *refusal;
    }
    std::vector<HeldContact> held = configuration.springs;
    sort_contacts(held);
    springs_ = placed_contacts(list_, particles, held, spring_kinds(terms_));
    noise_.resize(list_.pairs().size());
    varying_ = FlowAtCentres(particles.count(), /*threads=*/1);
    varying_.set(configuration.physics.flow.at(configuration.box), particles, 0, particles.count());
    if (configuration.noise) find_noise(*configuration.noise);
  }

  Json run() {
    for (const TermRecipe& recipe : recipes_of(configuration_.physics)) add_pairs(recipe);
    add_one_body();
    add_uniform_flow();
    Json answer = by_term_.json();
    answer["springs"] = configuration_.advance ? advanced_springs() : Json::array();
    return answer;
  }

 private:
  struct Loads {
    VectorField force, torque;
    PairSums sums;
  };

  void find_noise(const GivenNoise& noise) {
    std::map<PairName, NormalPair> given;
    for (const GivenPairNoise& pair : noise.pairs) {
      given[{pair.first, pair.second, pair.image}] = pair.normals;
    }
    for (std::size_t p = 0; p < noise_.size(); ++p) {
      const auto found = given.find(name_of(list_.pairs()[p]));
      noise_[p] = found == given.end() ? NormalPair{} : found->second;
    }
  }

  PairName name_of(const Pair& pair) const { return {pair.first, pair.second, list_.images()[pair.image]}; }

  Loads evaluate(const Terms& terms, const Physics& physics, double spring_timestep,
                 SpringField& springs) const {
    const std::size_t count = configuration_.particles.count();
    Loads loads = {VectorField(count), VectorField(count), {}};
    PairParameters parameters =
        pair_parameters(physics, configuration_.noise ? configuration_.noise->timestep : 0);
    parameters.spring_timestep = spring_timestep;
    const std::vector<PairKind> kinds =
        make_pair_kinds(physics, distinct_radii(configuration_.particles.radius));
    const PairPassInput input = {
        .particles = configuration_.particles,
        .list = list_,
        .box = configuration_.box,
        .kinds = kinds,
        .parameters = parameters,
        .noise = {},
        .given_noise = &noise_,
        .varying = feels_varying_flow(physics) ? &varying_ : nullptr,
    };
    if (list_.pairs().empty()) return loads;
    if (is_as_card_) {
      loads.sums = evaluate_as_card(physics, terms, input, springs, loads.force, loads.torque);
    } else {
      loads.sums = PairPass(terms, set_).evaluate(input, springs, loads.force, loads.torque);
    }
    return loads;
  }

  void add_pairs(const TermRecipe& recipe) {
    SpringField springs = springs_, untouched = springs_;
    const Loads with = evaluate(recipe.with, recipe.physics, 0, springs),
                without = evaluate(recipe.without, recipe.physics, 0, untouched);
    for (std::size_t i = 0; i < configuration_.particles.count(); ++i) {
      by_term_.add_single(recipe.name, i, with.force[i] - without.force[i],
                          with.torque[i] - without.torque[i]);
    }
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      if (recipe.name == std::string_view(engine::name_of(static_cast<StressTerm>(t)))) {
        by_term_.add_stress(recipe.name, (1 / configuration_.box.volume()) * with.sums.stress[t]);
      }
    }
  }

  Json advanced_springs() const {
    Json advanced = Json::array();
    if (!terms_.friction) return advanced;
    SpringField springs = springs_;
    evaluate(terms_, configuration_.physics, *configuration_.advance, springs);
    const std::vector<ImageFrame> frames = image_frames(list_, configuration_.box);
    for (std::size_t p = 0; p < list_.pairs().size(); ++p) {
      const Pair& pair = list_.pairs()[p];
      const PairGeometry shape =
          geometry(separation(configuration_.particles, pair, frames[pair.image]), kinds_[pair.kind]);
      if (!(shape.overlap() > 0)) continue;
      const LatticeShift image = list_.images()[pair.image];
      advanced.push_back({{"i", pair.first},
                          {"j", pair.second},
                          {"image", {image.x, image.y, image.z}},
                          {"tangential", to_json(springs[p].tangential)},
                          {"rolling", to_json(springs[p].rolling)}});
      if (springs.remembers_sliding()) advanced.back()["slides"] = springs[p].slides != 0;
    }
    return advanced;
  }

  void add_one_body() {
    System system;
    system.particles = configuration_.particles;
    system.box = configuration_.box;
    const std::size_t count = system.particles.count();
    const ForceField field(configuration_.physics, system.particles,
                           configuration_.noise ? configuration_.noise->timestep : 0, /*seed=*/0,
                           /*threads=*/1, set_);
    VectorField force(count), torque(count), noise_force(count), noise_torque(count);
    field.one_body().set_drag(field.one_body_input(system, force, torque), 0, count);
    field.add_varying_drag(system, 0, count, force, torque);
    for (std::size_t i = 0; i < count; ++i) {
      by_term_.add_single("drag", i, force[i], torque[i]);
      if (configuration_.noise) {
        const NormalPair normals = {configuration_.noise->force[i], configuration_.noise->torque[i]};
        field.add_drag_noise(system, i, normals, noise_force, noise_torque);
        by_term_.add_single("brownian_drag", i, noise_force[i], noise_torque[i]);
      }
    }
  }

  void add_uniform_flow() {
    const Physics& physics = configuration_.physics;
    const SymmetricTensor solvent = solvent_stress(physics.viscosity, configuration_.box.velocity_gradient());
    by_term_.add_stress("solvent", solvent);
    by_term_.add_stress(
        "stresslet",
        stresslet(solid_volume(configuration_.particles) / configuration_.box.volume(), solvent) +
            varying_stresslet(configuration_.particles, configuration_.box, physics));
  }

  const Configuration& configuration_;
  Terms terms_;
  bool is_as_card_;
  InstructionSet set_;
  ByTerm by_term_;
  std::vector<PairKind> kinds_;
  NeighbourList list_;
  SpringField springs_;
  std::vector<NormalPair> noise_;  // has an entry for each pair
  FlowAtCentres varying_;
};

}  // namespace

Json evaluate_configuration(const Configuration& configuration) { return Evaluation(configuration).run(); }

}  // namespace peclet::engine
