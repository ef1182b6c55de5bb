// The answer to `peclet-engine forces`: the same pair_terms() as in the time loop, term by term.
#include <algorithm>
#include <map>
#include <tuple>

#include "engine/configuration.h"
#include "engine/kernels/pair_access.h"
#include "engine/kernels/pair_terms.h"
#include "engine/kernels/recipes.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

using PairName = std::tuple<std::uint32_t, std::uint32_t, LatticeShift>;

Json to_json(const VectorField& field) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < field.size(); ++i) {
    rows.push_back({field.x[i], field.y[i], field.z[i]});
  }
  return rows;
}

Json to_json(const Vector3& v) { return {v.x, v.y, v.z}; }

Json to_json(const SymmetricTensor& t) {
  return {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
}

// Forces, torques and stress of each term that occurs.
class ByTerm {
 public:
  explicit ByTerm(const Configuration& configuration) : configuration_(configuration) {}

  void add_pair(const char* term, const Pair& pair, const Vector3& r, const PairLoad& load) {
    Sums& sums = of(term);
    sums.force.set(pair.first, sums.force[pair.first] + load.force);
    sums.force.set(pair.second, sums.force[pair.second] - load.force);
    sums.torque.set(pair.first, sums.torque[pair.first] + load.torque_first);
    sums.torque.set(pair.second, sums.torque[pair.second] + load.torque_second);
    sums.stress += (1 / configuration_.box.volume()) * symmetric_dyad(r, load.force);
  }

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

class Evaluation {
 public:
  explicit Evaluation(const Configuration& configuration)
      : configuration_(configuration), by_term_(configuration) {
    const std::vector<double> sizes = distinct_radii(configuration.particles.radius);
    kinds_ = make_pair_kinds(configuration.physics, sizes);
    list_ = NeighbourList(range_table(kinds_, sizes.size()), 0);
    list_.build(configuration.particles, configuration.box);
    frames_ = image_frames(list_, configuration.box);
    for (const HeldContact& contact : configuration.springs) {
      springs_[{contact.first, contact.second, contact.image}] = contact.springs;
    }
    if (configuration.noise) {
      for (const GivenPairNoise& given : configuration.noise->pairs) {
        noise_[{given.first, given.second, given.image}] = given.normals;
      }
    }
  }

  Json run() {
    with_recipe(required_terms(configuration_.physics), [&]<Terms terms>() {
      add_pairs<terms>();
      if (configuration_.advance) {
        advance_springs<terms>();
      }
    });
    add_one_body();
    add_uniform_flow();
    Json answer = by_term_.json();
    answer["springs"] = advanced_;
    return answer;
  }

 private:
  template <Terms terms, class Use>
  void for_each_pair(double spring_timestep, Use&& use) {
    const double noise_timestep = configuration_.noise ? configuration_.noise->timestep : 0;
    PairParameters parameters = pair_parameters(configuration_.physics, noise_timestep);
    parameters.spring_timestep = spring_timestep;
    for (const Pair& pair : list_.pairs()) {
      const PairKind& kind = kinds_[pair.kind];
      const ImageFrame& frame = frames_[pair.image];
      const PairGeometry shape = geometry(separation(configuration_.particles, pair, frame), kind);
      const PairName name = {pair.first, pair.second, list_.images()[pair.image]};
      const auto held = springs_.find(name);
      ContactSprings springs = held == springs_.end() ? ContactSprings{} : held->second;
      const TermLoads loads = pair_terms<terms>(parameters, kind, shape,
                                                motion(configuration_.particles, pair, frame), &springs, [&] {
                                                  const auto given = noise_.find(name);
                                                  return given == noise_.end() ? NormalPair{} : given->second;
                                                });
      use(pair, shape, loads, springs);
    }
  }

  template <Terms terms>
  void add_pairs() {
    for_each_pair<terms>(
        0, [&](const Pair& pair, const PairGeometry& shape, const TermLoads& loads, const ContactSprings&) {
          const auto add = [&](const char* term, bool present, const PairLoad& load) {
            if (present) {
              by_term_.add_pair(term, pair, shape.separation, load);
            }
          };
          add("lubrication", terms.lubrication, loads.lubrication);
          add("brownian_lubrication", terms.noise, loads.noise);
          add("contact_normal", terms.contact, {loads.contact_normal, {}, {}});
          add("contact_damping", terms.damping, {loads.contact_damping, {}, {}});
          add("friction", terms.friction, loads.friction);
          add("rolling", terms.rolling, loads.rolling);
          add("repulsion", terms.repulsion, {loads.repulsion, {}, {}});
        });
  }

  template <Terms terms>
  void advance_springs() {
    advanced_ = Json::array();
    for_each_pair<terms>(*configuration_.advance, [&](const Pair& pair, const PairGeometry& shape,
                                                      const TermLoads&, const ContactSprings& springs) {
      if (terms.friction && shape.overlap() > 0) {
        const LatticeShift image = list_.images()[pair.image];
        advanced_.push_back({{"i", pair.first},
                             {"j", pair.second},
                             {"image", {image.x, image.y, image.z}},
                             {"tangential", to_json(springs.tangential)},
                             {"rolling", to_json(springs.rolling)}});
      }
    });
  }

  void add_one_body() {
    const Physics& physics = configuration_.physics;
    const ParticleState& particles = configuration_.particles;
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const double zeta = translational_drag(physics.viscosity, particles.radius[i]);
      const double zeta_r = rotational_drag(physics.viscosity, particles.radius[i]);
      const Vector3 streaming = streaming_velocity(physics.shear_rate, particles.position.y[i]);
      by_term_.add_single(
          "drag", i, drag_force(zeta, streaming, particles.velocity[i]),
          drag_force(zeta_r, streaming_spin(physics.shear_rate), particles.angular_velocity[i]));
      if (configuration_.noise) {
        const double amplitude = std::sqrt(2 * physics.thermal_energy / configuration_.noise->timestep);
        by_term_.add_single("brownian_drag", i, drag_noise(amplitude, zeta, configuration_.noise->force[i]),
                            drag_noise(amplitude, zeta_r, configuration_.noise->torque[i]));
      }
    }
  }

  // 2 eta E of the solvent, and 20/3 pi eta a^3 E of each isolated sphere.
  void add_uniform_flow() {
    const Physics& physics = configuration_.physics;
    SymmetricTensor solvent;
    solvent.xy = physics.viscosity * physics.shear_rate;
    by_term_.add_stress("solvent", solvent);
    const double volume_fraction = solid_volume(configuration_.particles) / configuration_.box.volume();
    by_term_.add_stress("stresslet", (2.5 * volume_fraction) * solvent);
  }

  const Configuration& configuration_;
  ByTerm by_term_;
  std::vector<PairKind> kinds_;
  NeighbourList list_;
  std::vector<ImageFrame> frames_;
  std::map<PairName, ContactSprings> springs_;
  std::map<PairName, NormalPair> noise_;
  Json advanced_ = Json::array();
};

}  // namespace

Json evaluate_configuration(const Configuration& configuration) { return Evaluation(configuration).run(); }

}  // namespace peclet::engine
