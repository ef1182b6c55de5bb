// Writes frames of a realisation for other programs: centres, motion and stress of each sphere and, if asked
// for, contacts. The file is GSD of the schema "hoomd" 1.4, in the units of the scene.
//
// Spheres are in the order of their ids. A centre is the image in the cell around the origin, -1/2 <=
// fractional < 1/2, and velocity is that of this image (the streaming flow there is rate y). The unwrapped
// position is centre + image . lattice vectors of the frame, also after changes of the basis of the cell.
//
// A frame has its first lattice vector along x and its second one in the xy plane. The cell of an extension
// or a cross shear does not: positions and motion are then components along the rows of log/axes, unit
// vectors in the axes of the flow. Stress is in the axes of the flow.
//
// Positions, motion and contacts are those at the end of a step. Stress is that of the step, which the means
// of the result add up. log/particles/stress is V sigma_i (sphere_stress.h), xx yy zz xy xz yz.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "contract/errors.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/observables/observable.h"
#include "engine/observables/sphere_stress.h"
#include "engine/observables/structure.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Limits for an index that is small in a checkpoint, and for the largest file that a campaign takes.
constexpr std::uint64_t most_frames = 50'000, most_bytes = std::uint64_t{1} << 32;

// The bytes of a sphere (position, image, velocity, spin, stress, contacts), of a contact (group, three
// numbers, state) and of a frame besides. A sphere has at most six contacts on average, as two share each.
constexpr std::uint64_t of_sphere = 4 * 12 + 24 + 4, of_contact = 8 + 3 * 4 + 1, contacts_of_sphere = 6,
                        of_frame = 2048;

enum class State : std::uint8_t { frictionless, sticking, sliding };

void append(std::vector<float>& values, const Vector3& v) {
  for (const double x : {v.x, v.y, v.z}) values.push_back(static_cast<float>(x));
}

// Returns "A", "B" ... "Z", "27", "28" ... in rows of equal length that end with a zero.
std::vector<std::int8_t> names_of_species(std::uint32_t count, std::uint32_t& columns) {
  constexpr std::uint32_t letters = 26;
  columns = 4;
  std::vector<std::int8_t> names;
  for (std::uint32_t s = 0; s < count; ++s) {
    std::string name = s < letters ? std::string(1, static_cast<char>('A' + s)) : std::to_string(s + 1);
    name.resize(columns, '\0');
    names.insert(names.end(), name.begin(), name.end());
  }
  return names;
}

void check_frames(const Plan& plan, bool contacts) {
  const std::uint64_t bytes =
      of_frame + plan.scene.particles.count * (of_sphere + (contacts ? contacts_of_sphere * of_contact : 0));
  const std::uint64_t most = std::min(most_frames, most_bytes / bytes);
  if (plan.samples() <= most) return;
  throw InputError(
      plan.file, "/trajectory/interval", fmt::format("{} frames", plan.samples()),
      fmt::format("must leave at most {} frames of up to {} bytes in the production window of {} steps", most,
                  bytes, plan.window.steps));
}

class Trajectory : public Observable {
 public:
  Trajectory(const Plan& plan, bool with_contacts)
      : Observable(plan),
        particles_(plan.scene.particles),
        physics_(plan.scene.physics),
        stress_(physics_),
        kinds_(pair_kinds_in(plan.scene)),
        with_contacts_(with_contacts),
        turns_(!plain_flow(physics_.flow.deformation().velocity_gradient(0)).is_simple_shear) {
    check_frames(plan, with_contacts);
    keep(frames_);
  }

  PairWatcher* watcher() override { return &stress_; }
  gsd::Frames* frames() override { return &frames_; }

  void sample(const System& system, std::size_t /*block*/) override {
    frames_.add_single<std::uint64_t>("configuration/step", system.step);
    add_places(system);
    if (frames_.count() == 0) add_kinds_of_spheres(system);
    frames_.add_single("log/time", system.clock.time());
    frames_.add_single("log/strain", system.box.net_strain());
    add_stress(system);
    add_contacts(system);
    frames_.end_frame();
    stress_.clear();
  }

 private:
  void add_kinds_of_spheres(const System& system) {
    const ParticleState& particles = system.particles;
    const std::vector<std::size_t> number = species_numbers(particles_);
    std::uint32_t columns = 0;
    const std::vector<std::int8_t> names =
        names_of_species(static_cast<std::uint32_t>(number.size()), columns);
    std::vector<std::uint32_t> species;  // for each id
    for (std::uint32_t s = 0; s < number.size(); ++s) species.insert(species.end(), number[s], s);
    std::vector<float> diameter, mass;
    for (const std::uint32_t i : places_of_ids(particles)) {
      diameter.push_back(static_cast<float>(2 * particles.radius[i]));
      mass.push_back(static_cast<float>(particles.mass[i]));
    }
    frames_.add("particles/types", names, columns);
    frames_.add("particles/typeid", species);
    frames_.add("particles/diameter", diameter);
    frames_.add("particles/mass", mass);
  }

  void add_places(const System& system) {
    const ParticleState& particles = system.particles;
    const PeriodicCell& box = system.box;
    const CellFrame cell = box.frame();
    const auto& axis = cell.axes.column;
    const auto turned = [&](const Vector3& v) {
      return Vector3{dot(axis[0], v), dot(axis[1], v), dot(axis[2], v)};
    };
    std::vector<float> shape, position, velocity, spin;
    std::vector<std::int32_t> image;
    append(shape, cell.lengths);
    append(shape, {cell.tilt_xy / cell.lengths.y, cell.xz / cell.lengths.z, cell.yz / cell.lengths.z});
    for (const std::uint32_t i : places_of_ids(particles)) {
      const LatticeShift removed = cells_from_origin(cell, particles.position[i]);
      const LatticeShift all = particles.image[i] + removed;
      append(position, turned(particles.position[i] - box.displacement(removed)));
      append(velocity, turned(particles.velocity[i] - box.velocity(removed)));
      append(spin, turned(particles.angular_velocity[i]));
      image.insert(image.end(), {all.x, all.y, all.z});
    }
    frames_.add("configuration/box", shape);
    frames_.add_single("particles/N", static_cast<std::uint32_t>(particles.count()));
    frames_.add("particles/position", position, 3);
    frames_.add("particles/image", image, 3);
    frames_.add("particles/velocity", velocity, 3);
    frames_.add("log/particles/angular_velocity", spin, 3);
    if (!turns_) return;
    std::vector<double> axes;
    for (const Vector3& a : axis) axes.insert(axes.end(), {a.x, a.y, a.z});
    frames_.add("log/axes", axes, 3);
  }

  void add_stress(const System& system) {
    const double volume = system.box.volume();
    const SymmetricTensor solvent = solvent_stress(physics_.viscosity, system.box.velocity_gradient());
    const std::vector<SymmetricTensor> own = stress_.stresslets(system);
    SymmetricTensor alone;
    std::vector<float> of_spheres;
    for (std::size_t id = 0; id < own.size(); ++id) {
      alone += own[id];
      for (const double x : components_of(own[id] + stress_.shares()[id])) {
        of_spheres.push_back(static_cast<float>(x));
      }
    }
    const SymmetricTensor stresslet = (1 / volume) * alone;
    frames_.add("log/particles/stress", of_spheres, 6);
    frames_.add("log/stress/total",
                components_of(solvent + stresslet +
                              (1 / volume) * (total_stress(stress_.pairs()) + stress_.motion())));
    frames_.add("log/stress/solvent", components_of(solvent));
    frames_.add("log/stress/stresslet", components_of(stresslet));
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      const auto term = static_cast<StressTerm>(t);
      if (!has_stress_term(physics_, term)) continue;
      frames_.add(std::string("log/stress/") + name_of(term),
                  components_of((1 / volume) * stress_.pairs().of(term)));
    }
    if (physics_.thermal_energy > 0)
      frames_.add("log/stress/motion", components_of((1 / volume) * stress_.motion()));
  }

  void add_contacts(const System& system) {
    if (!physics_.contact) return;
    const ContactParameters& contact = *physics_.contact;
    const ParticleState& particles = system.particles;
    std::vector<std::uint32_t> number(particles.count());
    struct Bond {
      std::array<std::uint32_t, 2> group;
      float gap, normal, tangential;
      State state;
    };
    std::vector<Bond> bonds;
    for_each_touching_pair(system, kinds_, contact, [&](const TouchingPair& touching) {
      const std::uint32_t i = particles.id[touching.pair.first], j = particles.id[touching.pair.second];
      ++number[i];
      ++number[j];
      const PairKind& kind = kinds_[touching.pair.kind];
      const State state = !touching.rough   ? State::frictionless
                          : touching.slides ? State::sliding
                                            : State::sticking;
      bonds.push_back({{std::min(i, j), std::max(i, j)},
                       static_cast<float>(-2 * touching.overlap / kind.sum_of_radii),
                       static_cast<float>(contact_push(contact.normal_stiffness, touching.overlap)),
                       static_cast<float>(touching.tangential_force),
                       state});
    });
    frames_.add("log/particles/contact_number", number);
    if (!with_contacts_) return;
    // The sort is stable: contacts of one pair through two images keep the order of the list.
    std::ranges::stable_sort(bonds, {}, &Bond::group);
    std::vector<std::uint32_t> group;
    std::vector<float> gap, normal, tangential;
    std::vector<std::uint8_t> state;
    for (const Bond& bond : bonds) {
      group.insert(group.end(), bond.group.begin(), bond.group.end());
      gap.push_back(bond.gap);
      normal.push_back(bond.normal);
      tangential.push_back(bond.tangential);
      state.push_back(static_cast<std::uint8_t>(bond.state));
    }
    frames_.add_single("bonds/N", static_cast<std::uint32_t>(bonds.size()));
    if (frames_.count() == 0) {
      constexpr char name[] = "contact";
      frames_.add("bonds/types", std::vector<std::int8_t>(std::begin(name), std::end(name)), sizeof name);
    }
    frames_.add("bonds/group", group, 2);
    frames_.add("log/bonds/gap", gap);
    frames_.add("log/bonds/normal_force", normal);
    frames_.add("log/bonds/tangential_force", tangential);
    frames_.add("log/bonds/state", state);
  }

  Particles particles_;
  Physics physics_;
  SphereStress stress_;
  std::vector<PairKind> kinds_;
  bool with_contacts_;
  bool turns_;  // true if the cell is turned relative to the axes of the flow
  gsd::Frames frames_;
};

}  // namespace

ObservableKind trajectory() {
  return {.name = "trajectory",
          .meaning =
              "the file trajectory.gsd beside the result, with position, motion and stress of each sphere "
              "in every frame",
          .interval_is_a_duration = true,
          .settings =
              "/trajectory/contacts | true or false; default false | "
              "Whether frames list the contacts, with their forces.",
          .read = [](const SceneDocument& document, const Scene& scene) {
            const bool contacts = document.at("/trajectory/contacts").get<bool>();
            if (contacts && !scene.physics.contact) {
              document.refuse("/trajectory/contacts", "must be false without /contact");
            }
            return maker<Trajectory>(contacts);
          }};
}

}  // namespace peclet::engine
