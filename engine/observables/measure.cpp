// Lets a Python script of the user measure frames; the numbers that it returns become quantities
// measure/NAME.
//
// A frame has the spheres in the order of their ids, in the cell around the origin, at the end of a step. Its
// pairs are all whose centres are within the range of a force. Stress and force of a pair are those of the
// step, noise included. docs/measure.md describes the members.
#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "contract/scene_script.h"
#include "engine/observables/observable.h"
#include "engine/observables/script_process.h"
#include "engine/observables/sphere_stress.h"
#include "engine/observables/structure.h"

namespace peclet::engine {
namespace {

using Ids = std::pair<std::uint32_t, std::uint32_t>;

Ids ids_of(const System& system, const Pair& pair) {
  return {system.particles.id[pair.first], system.particles.id[pair.second]};
}

// The arrays of a frame: their names and shapes, and the bytes of their elements one after the other.
class Arrays {
 public:
  void add(const std::string& name, const std::vector<double>& values, const Json& shape) {
    put(name, "<f8", std::as_bytes(std::span(values)), shape);
  }
  void add(const std::string& name, const std::vector<std::int64_t>& values) {
    put(name, "<i8", std::as_bytes(std::span(values)), {values.size()});
  }
  const Json& heads() const { return heads_; }
  const std::string& bytes() const { return bytes_; }

 private:
  void put(const std::string& name, const char* kind, std::span<const std::byte> bytes, const Json& shape) {
    heads_.push_back({name, kind, shape});
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }

  Json heads_ = Json::array();
  std::string bytes_;
};

void append(std::vector<double>& values, const Vector3& v) { values.insert(values.end(), {v.x, v.y, v.z}); }

// The forces on the first spheres of pairs, averaged over a step.
class PairForces final : public PairWatcher {
 public:
  void clear() { forces_.clear(); }

  // Returns the force of a pair; zero if it was not within range. `near` is well below the distance between
  // two images of one sphere and well above what spheres move in a step.
  Vector3 of(const Ids& ids, const Vector3& separation, double near) {
    if (!is_sorted_) std::ranges::stable_sort(forces_, {}, &Force::ids);
    is_sorted_ = true;
    Vector3 sum{};
    for (auto force = std::ranges::lower_bound(forces_, ids, {}, &Force::ids);
         force != forces_.end() && force->ids == ids; ++force) {
      if (norm(force->separation - separation) < near) sum += force->force;
    }
    return sum;
  }

 private:
  struct Force {
    Ids ids;
    Vector3 separation, force;
  };

  void begin(const System& system, double weight) override {
    weight_ = weight;
    images_ = image_frames(system.list, system.box);
  }
  void take(const System& system, const Pair& pair, const PairSums& /*sums*/, const Vector3& force) override {
    forces_.push_back(
        {ids_of(system, pair), separation(system.particles, pair, images_[pair.image]), weight_ * force});
    is_sorted_ = false;
  }
  void take_motion(const System&, std::size_t, const SymmetricTensor&) override {}

  double weight_ = 0;
  std::vector<ImageFrame> images_;
  std::vector<Force> forces_;
  bool is_sorted_ = true;
};

// Returns the descriptions of a script's quantities. Starts it once for each text. Throws as ScriptProcess.
Json quantities_of(const Script& script) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, Json> known;
  const std::lock_guard lock(mutex);
  Json& quantities = known[{script.name, script.text}];
  if (quantities.is_null()) quantities = ScriptProcess(script).quantities();
  return quantities;
}

class Measure : public Observable {
 public:
  Measure(const Plan& plan, const Script& script)
      : Observable(plan),
        script_(script),
        particles_(plan.scene.particles),
        contact_(plan.scene.physics.contact),
        kinds_(pair_kinds_in(plan.scene)),
        stress_(plan.scene.physics) {
    for (const Json& about : quantities_of(script)) {
      const auto name = about.at("name").get<std::string>();
      Quantity quantity{.name = "measure/" + name,
                        .symbol = about.at("symbol").get<std::string>(),
                        .unit = about.at("unit").get<std::string>()};
      for (const Json& axis : about.at("axes")) {
        quantity.axes.push_back(
            {axis.at("name").get<std::string>(), axis.at("unit").get<std::string>(), axis.at("values")});
      }
      means_.emplace_back(name, &mean(quantity));
    }
    watchers_.add(&stress_);
    watchers_.add(&forces_);
  }

  PairWatcher* watcher() override { return &watchers_; }

  void sample(const System& system, std::size_t block) override {
    if (!process_) process_ = std::make_unique<ScriptProcess>(script_);
    Arrays arrays;
    add_spheres(system, arrays);
    add_pairs(system, arrays);
    stress_.clear();
    forces_.clear();
    const Json answer = process_->ask({{"type", "frame"},
                                       {"step", system.step},
                                       {"time", system.clock.time()},
                                       {"strain", system.box.net_strain()},
                                       {"arrays", arrays.heads()}},
                                      arrays.bytes());
    for (const auto& [name, mean] : means_) {
      const Json& values = answer.at("values").at(name);
      if (values.is_null()) continue;
      for (std::size_t element = 0; element < values.size(); ++element) {
        mean->add(block, element, values[element].get<double>());
      }
      mean->weigh(block, 1);
    }
  }

  double take_seconds() override { return process_ ? process_->take_seconds() : 0; }

 private:
  void add_spheres(const System& system, Arrays& arrays) const {
    const ParticleState& particles = system.particles;
    const CellFrame cell = system.box.frame();
    std::vector<double> box, position, velocity, spin, radius, stress;
    for (const Vector3& edge : system.box.edges().column) append(box, edge);
    for (const std::uint32_t i : places_of_ids(particles)) {
      const LatticeShift removed = cells_from_origin(cell, particles.position[i]);
      append(position, particles.position[i] - system.box.displacement(removed));
      append(velocity, particles.velocity[i] - system.box.velocity(removed));
      append(spin, particles.angular_velocity[i]);
      radius.push_back(particles.radius[i]);
    }
    const std::vector<SymmetricTensor> own = stress_.stresslets(system);
    for (std::size_t id = 0; id < own.size(); ++id) {
      const std::vector<double> parts = components_of(own[id] + stress_.shares()[id]);
      stress.insert(stress.end(), parts.begin(), parts.end());
    }
    std::vector<std::int64_t> species;
    const std::vector<std::size_t> number = species_numbers(particles_);
    for (std::size_t s = 0; s < number.size(); ++s)
      species.insert(species.end(), number[s], static_cast<std::int64_t>(s));
    const std::size_t count = particles.count();
    arrays.add("box", box, {3, 3});
    arrays.add("positions", position, {count, 3});
    arrays.add("velocities", velocity, {count, 3});
    arrays.add("spins", spin, {count, 3});
    arrays.add("radii", radius, {count});
    arrays.add("species", species);
    arrays.add("stress", stress, {count, 6});
  }

  struct Row {
    Ids ids;
    Vector3 separation;
    double distance, sum_of_radii;
    double normal_force = 0, tangential_force = 0;  // of a contact
    bool slides = false;
  };

  // Returns the pairs within the range of the forces, in the order of ids.
  std::vector<Row> rows_of(const System& system) const {
    const std::vector<ImageFrame> images = image_frames(system.list, system.box);
    const std::vector<Pair>& pairs = system.list.pairs();
    const RangeTable& ranges = system.list.ranges();
    std::vector<Row> rows(pairs.size());
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const Vector3 r = separation(system.particles, pairs[p], images[pairs[p].image]);
      rows[p] = {ids_of(system, pairs[p]), r, norm(r), kinds_[pairs[p].kind].sum_of_radii};
    }
    if (contact_) {
      for_each_touching_pair(system, kinds_, *contact_, [&](const TouchingPair& touching) {
        Row& row = rows[static_cast<std::size_t>(&touching.pair - pairs.data())];
        row.normal_force = contact_push(contact_->normal_stiffness, touching.overlap);
        row.tangential_force = touching.tangential_force;
        row.slides = touching.slides;
      });
    }
    std::size_t kept = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const std::size_t kind = pairs[p].kind, classes = ranges.classes();
      if (rows[p].distance < ranges.at(kind / classes, kind % classes)) rows[kept++] = rows[p];
    }
    rows.resize(kept);
    std::ranges::stable_sort(rows, {}, &Row::ids);
    return rows;
  }

  void add_pairs(const System& system, Arrays& arrays) {
    const double near = 0.5 * *std::ranges::min_element(system.particles.radius);
    std::vector<std::int64_t> first, second, sliding;
    std::vector<double> separation, normal, gap, force, normal_force, tangential_force;
    const std::vector<Row> rows = rows_of(system);
    for (const Row& row : rows) {
      first.push_back(row.ids.first);
      second.push_back(row.ids.second);
      append(separation, row.separation);
      append(normal, (1 / row.distance) * row.separation);
      gap.push_back(2 * (row.distance - row.sum_of_radii) / row.sum_of_radii);
      append(force, forces_.of(row.ids, row.separation, near));
      normal_force.push_back(row.normal_force);
      tangential_force.push_back(row.tangential_force);
      sliding.push_back(row.slides ? 1 : 0);
    }
    arrays.add("pair/first", first);
    arrays.add("pair/second", second);
    arrays.add("pair/separation", separation, {rows.size(), 3});
    arrays.add("pair/normal", normal, {rows.size(), 3});
    arrays.add("pair/gap", gap, {rows.size()});
    arrays.add("pair/force", force, {rows.size(), 3});
    arrays.add("pair/normal_force", normal_force, {rows.size()});
    arrays.add("pair/tangential_force", tangential_force, {rows.size()});
    arrays.add("pair/sliding", sliding);
  }

  Script script_;
  Particles particles_;
  std::optional<ContactParameters> contact_;
  std::vector<PairKind> kinds_;
  SphereStress stress_;
  PairForces forces_;
  PairWatchers watchers_;
  std::vector<std::pair<std::string, BlockedMean*>> means_;
  std::unique_ptr<ScriptProcess> process_;  // from the first sample on
};

}  // namespace

ObservableKind measure() {
  return {.name = "measure",
          .meaning = "numbers that a Python script of your own computes from frames",
          .sampling = Sampling::rarely,
          .settings = R"(
/measure/script | string | File with the script, relative to the folder of the scene or campaign. It is run by the
    python3 in PATH.
/measure/text? | string | The script itself. The programs put it here when they read the file, so that it
    belongs to the point and goes wherever the scene goes.
/measure/patience | number > 0 and <= 86400; default 60 | Time after which a frame without an answer ends the
    realisation, in seconds.
)",
          .read = [](const SceneDocument& document, const Scene& scene) {
            if (!document.has("/measure/text"))
              document.miss("/measure/text", "must be the text of the script, which an engine does not read");
            Json told = scene.document;
            told.erase("measure");
            const Script script{document.at("/measure/script").get<std::string>(),
                                document.at("/measure/text").get<std::string>(), told.dump(),
                                std::chrono::duration<double>(document.number("/measure/patience"))};
            if (script.text.size() > longest_script)
              document.refuse("/measure/text", "must have at most {} bytes", longest_script);
            try {
              quantities_of(script);
            } catch (const ScriptError& error) {
              throw InputError(document.file(), "/measure/script", "", error.what());
            }
            return maker<Measure>(script);
          }};
}

}  // namespace peclet::engine
