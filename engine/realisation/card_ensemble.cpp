#include "engine/realisation/card_ensemble.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "engine/card/card_setup.h"
#include "engine/integrators/acted_stress.h"
#include "engine/integrators/implicit.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/realisation/checkpoint.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/simulation.h"
#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

// An emulated card has no clock: a call makes this many steps at most.
constexpr std::uint64_t emulated_steps = 64, enough_steps = std::uint64_t{1} << 40;

// The norm of own blocks sees slow motions later than that of the processor's preconditioner. With noise,
// where each system is solved once, the solver goes on to this share of the tolerance. The errors of the
// velocities are then those of the processor (docs/implementers.md).
constexpr double share_of_tolerance_with_noise = 0.6;

// Room of a slot at first: pairs over those that its list holds, and candidates of a sphere.
constexpr double spare_pairs = 1.5;
constexpr std::uint32_t usual_candidates = 64;

CardRoom at_least(const CardRoom& a, const CardRoom& b) {
  return {std::max(a.pairs, b.pairs), std::max(a.neighbours, b.neighbours)};
}

// The state of an integrator between steps, in the order of its archive.
struct Kept {
  VectorField velocity_change, spin_change;  // without noise
  double displacement_bound = 0;
};
Kept kept_by(const Integrator& integrator, std::size_t particles, bool noisy) {
  ArchiveWriter archive;
  integrator.save(archive);
  ArchiveReader reader(archive.bytes());
  Kept kept{VectorField(particles), VectorField(particles)};
  if (!noisy) reader.get_all(kept.velocity_change, kept.spin_change);
  reader.get_all(kept.displacement_bound);
  return kept;
}
void give_back(Integrator& integrator, const Kept& kept, bool noisy) {
  ArchiveWriter archive;
  if (!noisy) archive.put_all(kept.velocity_change, kept.spin_change);
  archive.put_all(kept.displacement_bound);
  ArchiveReader reader(archive.bytes());
  integrator.load(reader);
}

}  // namespace

// Memory of the device that is released with its owner.
class CardEnsemble::OwnedMemory {
 public:
  OwnedMemory(CardDevice& device, std::size_t bytes) : device_(device), memory_(device.allocate(bytes)) {}
  OwnedMemory(const OwnedMemory&) = delete;
  OwnedMemory& operator=(const OwnedMemory&) = delete;
  ~OwnedMemory() { device_.release(memory_); }

  std::byte* get() const { return static_cast<std::byte*>(memory_); }

 private:
  CardDevice& device_;
  void* memory_;
};

struct CardEnsemble::LoadedScene {
  unsigned variant = 0;
  CardScene scene{};
  std::vector<std::uint16_t> size_class;
  std::vector<CardSize> sizes;
  std::vector<CardLevel> levels;
  std::vector<PairKind> kinds;
  std::vector<double> reach, candidate_reach;
  std::unique_ptr<OwnedMemory> memory;
  CardRoom room{};  // that a realisation has needed
};

struct CardEnsemble::Slot {
  Simulation* simulation = nullptr;
  std::shared_ptr<LoadedScene> scene;
  std::unique_ptr<OwnedMemory> memory, progress_memory;
  CardRealisation own{};
  CardProgress progress{};
  StepErrors errors_at_home{};
};

CardEnsemble::CardEnsemble(std::unique_ptr<CardDevice> device)
    : device_(std::move(device)),
      most_steps_(device_->name() == "emulated" ? emulated_steps : enough_steps) {}
CardEnsemble::~CardEnsemble() = default;

std::optional<InputError> CardEnsemble::refusal(const Scene& scene, const std::string& file) const {
  const auto refuse = [&](const std::string& pointer, const char* allowed) {
    const Json::json_pointer place(pointer);
    const std::string value = scene.document.contains(place) ? shortened(scene.document.at(place)) : "";
    return InputError(file, pointer, value, std::string(allowed) + " for a card");
  };
  constexpr std::size_t most_sizes = 64;
  const Physics& physics = scene.physics;
  if (scene.method != Method::implicit_steps) return refuse("/integrator/method", "must be implicit");
  if (scene.particles.count > most_card_particles) return refuse("/particles/count", "must be at most 4096");
  if (distinct_radii(species_radii(scene.particles)).size() > most_sizes)
    return refuse("/particles/species", "must be at most 64 sizes");
  if (dynamic_cast<const SteadyShear*>(&physics.flow.deformation()) == nullptr || physics.flow.varies()) {
    return refuse("/flow", "must be steady shear");
  }
  if (!scene.observables.empty()) {
    return refuse("/observables", "must be absent: stress, contacts and temperatures only");
  }
  if (scene.start) return refuse("/start", "must be absent: spheres are packed");
  if (scene.height) return refuse("/box", "must be absent: a cube");
  if (device_->places(card_variant_of(physics).number(), scene.particles.count) == 0) {
    return refuse("/particles/count", "must fit into the shared memory of a thread block");
  }
  return std::nullopt;
}

// Variants with friction and noise need most of the card.
std::size_t CardEnsemble::capacity() const {
  constexpr std::size_t few = 1;
  return device_->places(count_of_card_variants - 1, few);
}

std::size_t CardEnsemble::capacity(const Scene& scene) const {
  if (refusal(scene, "")) return 0;
  return std::min(capacity(),
                  device_->places(card_variant_of(scene.physics).number(), scene.particles.count));
}

std::shared_ptr<CardEnsemble::LoadedScene> CardEnsemble::load(const Simulation& simulation) {
  const Scene& scene = simulation.scene_;
  const Schedule& schedule = simulation.schedule_;
  const System& system = simulation.system_;
  const Matrix3& edges = simulation.edges_at_start_;
  const std::string name = scene.document.dump() + std::to_string(schedule.equilibration) + ' ' +
                           std::to_string(schedule.production) + ' ' + std::to_string(edges.column[1].x) +
                           ' ' + std::to_string(edges.column[0].x);
  if (std::shared_ptr<LoadedScene> known = scenes_[name].lock()) return known;

  const auto loaded = std::make_shared<LoadedScene>();
  LoadedScene& own = *loaded;
  CardScene& card = own.scene;
  const Physics& physics = scene.physics;
  const ParticleState& particles = system.particles;
  const RangeTable& ranges = system.list.ranges();
  own.variant = card_variant_of(physics).number();
  own.size_class = particles.size_class;
  own.kinds = simulation.kinds_;
  card.particles = static_cast<std::uint32_t>(particles.count());
  card.classes = static_cast<std::uint32_t>(ranges.classes());
  card.lubricated = physics.lubrication.has_value();
  card.touching = physics.contact.has_value();
  const Terms terms = required_terms(physics);
  card.springs = terms.friction;
  card.carried_term = static_cast<std::uint32_t>(carried_term(physics));
  const double volume = system.box.volume();
  card.shell = structural_shell;
  card.per_structure = -physics.thermal_energy / (structural_shell * volume);
  const Matrix3 gradient = physics.flow.deformation().velocity_gradient(0);
  card.rate = gradient.column[1].x;
  card.edge_x = edges.column[0].x;
  card.edge_y = edges.column[1].y;
  card.edge_z = edges.column[2].z;
  card.skin = system.list.skin();
  card.skin_of_candidates = system.list.skin_of_candidates();
  card.smallest_range = ranges.smallest();
  card.largest_range = ranges.largest();
  const auto reach = [&](double range, double skin) {
    return range + skin * (card.smallest_range + 0.1 * (range - card.smallest_range));
  };
  for (std::size_t kind = 0; kind < own.kinds.size(); ++kind) {
    const double range = ranges.at(kind / ranges.classes(), kind % ranges.classes());
    const double near = reach(range, card.skin), far = reach(range, card.skin_of_candidates);
    own.reach.push_back(near * near);
    own.candidate_reach.push_back(far * far);
  }
  const double slope = 0.5 * card.edge_x / card.edge_y;
  const double narrowest = std::min({card.edge_x / std::sqrt(1 + slope * slope), card.edge_y, card.edge_z});
  const double farthest = reach(card.largest_range, card.skin_of_candidates);
  card.is_narrow = 2 * farthest >= narrowest;

  card.tolerance = scene.solver_tolerance * (physics.thermal_energy > 0 ? share_of_tolerance_with_noise : 1);
  card.tightness = std::min(card.tolerance / usual_tolerance, 1.0);
  const auto& steps = static_cast<const Implicit&>(*simulation.integrator_);
  card.longest_way = steps.longest_way();
  card.most_divisions = Implicit::deepest_division;
  card.largest_displacement =
      std::min(scene.guard.largest_displacement, 0.5 * card.largest_range / simulation.smallest_radius_);
  card.largest_overlap = scene.guard.largest_overlap;
  card.smallest_radius = simulation.smallest_radius_;
  card.equilibration = schedule.equilibration;
  card.total = schedule.total();
  card.sampling = simulation.at_most_a_block(steps.intervals().sampling);
  card.comparison = simulation.steps_between_comparisons();

  own.sizes = card_sizes(physics, particles);
  for (int division = 0; division < card_levels; ++division) {
    own.levels.push_back(card_level(physics, particles, std::ldexp(schedule.timestep, -division)));
  }

  // The scene and its arrays, in one piece of memory.
  CardParts measured(nullptr);
  const auto arrange = [&](CardParts& parts, CardScene*& at, CardScene& pointing) {
    parts.take(at, 1);
    parts.take(pointing.size_class, own.size_class.size());
    parts.take(pointing.sizes, own.sizes.size());
    parts.take(pointing.levels, own.levels.size());
    parts.take(pointing.kinds, own.kinds.size());
    parts.take(pointing.squared_reach, own.reach.size());
    parts.take(pointing.squared_candidate_reach, own.candidate_reach.size());
  };
  CardScene* place = nullptr;
  arrange(measured, place, card);
  own.memory = std::make_unique<OwnedMemory>(*device_, measured.used());
  CardParts parts(own.memory->get());
  arrange(parts, place, card);
  const auto upload = [&](const auto* to, const auto& from) {
    device_->upload(const_cast<void*>(static_cast<const void*>(to)), from.data(),
                    from.size() * sizeof from[0]);
  };
  upload(card.size_class, own.size_class);
  upload(card.sizes, own.sizes);
  upload(card.levels, own.levels);
  upload(card.kinds, own.kinds);
  upload(card.squared_reach, own.reach);
  upload(card.squared_candidate_reach, own.candidate_reach);
  device_->upload(place, &card, sizeof card);
  scenes_[name] = loaded;
  return loaded;
}

void CardEnsemble::add(Simulation& simulation) {
  slots_.push_back(std::make_unique<Slot>());
  Slot& slot = *slots_.back();
  slot.simulation = &simulation;
  slot.scene = load(simulation);
  slot.progress_memory = std::make_unique<OwnedMemory>(*device_, sizeof(CardProgress));
  const std::size_t listed = simulation.system_.list.pairs().size();
  const auto count = static_cast<std::uint32_t>(simulation.system_.particles.count());
  slot.own.room = {static_cast<std::uint32_t>(spare_pairs * static_cast<double>(listed)) + 2 * count,
                   usual_candidates};
  if (first_room_) slot.own.room = *first_room_;
  slot.own.room = at_least(slot.own.room, slot.scene->room);
  place(slot);
}

// Uploads the state of the Simulation into a slot of the present room.
void CardEnsemble::place(Slot& slot) {
  Simulation& simulation = *slot.simulation;
  const System& system = simulation.system_;
  const ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  const bool noisy = simulation.scene_.physics.thermal_energy > 0;
  slot.errors_at_home = simulation.errors_;
  CardRealisation& own = slot.own;

  // The pairs with springs, in the order of their first spheres.
  std::vector<std::size_t> sprung;
  for (std::size_t p = 0; p < system.list.pairs().size() && slot.scene->scene.springs; ++p) {
    const ContactSprings springs = system.springs[p];
    if (norm(springs.tangential) > 0 || norm(springs.rolling) > 0 || springs.slides != 0) sprung.push_back(p);
  }
  const std::vector<Pair>& pairs = system.list.pairs();
  std::ranges::stable_sort(sprung, {}, [&](std::size_t p) { return pairs[p].first; });
  own.room.pairs = std::max(own.room.pairs, static_cast<std::uint32_t>(sprung.size()));

  slot.memory.reset();
  slot.memory = std::make_unique<OwnedMemory>(*device_, share_out(nullptr, count, own));
  share_out(slot.memory->get(), count, own);
  own.progress = reinterpret_cast<CardProgress*>(slot.progress_memory->get());

  const Kept kept = kept_by(*simulation.integrator_, count, noisy);
  const auto upload = [&](auto* to, const auto& from) {
    if (!from.empty()) device_->upload(to, from.data(), from.size() * sizeof from[0]);
  };
  upload(own.position, rows_of(particles.position));
  upload(own.velocity, rows_of(particles.velocity));
  upload(own.spin, rows_of(particles.angular_velocity));
  upload(own.listed, rows_of(system.list.listed().position));
  upload(own.found, rows_of(system.list.moment_of_candidates().position));
  upload(own.velocity_change, rows_of(kept.velocity_change));
  upload(own.spin_change, rows_of(kept.spin_change));
  std::vector<std::array<std::int32_t, 4>> images;
  for (const LatticeShift& image : particles.image) images.push_back({image.x, image.y, image.z, 0});
  upload(own.image, images);

  std::vector<CardPair> old_pairs;
  std::vector<CardEnd> ends;
  std::vector<std::uint32_t> begin(count + 1);
  std::vector<double> springs(components_of_card_springs * own.room.pairs);
  for (const std::size_t p : sprung) {
    const auto number = static_cast<std::uint32_t>(old_pairs.size());
    old_pairs.push_back(card_pair(pairs[p], system.list.images()[pairs[p].image]));
    ends.push_back({2 * number, pairs[p].second});
    ++begin[pairs[p].first + 1];
    const auto values = card_components(system.springs[p]);
    for (std::size_t c = 0; c < components_of_card_springs; ++c)
      springs[c * own.room.pairs + number] = values[c];
  }
  for (std::size_t i = 0; i < count; ++i) begin[i + 1] += begin[i];
  upload(own.pair, old_pairs);
  upload(own.end, ends);
  upload(own.end_begin, begin);
  if (slot.scene->scene.springs) upload(own.springs, springs);

  std::vector<CardBlockSums> blocks(card_blocks);
  for (std::size_t b = 0; b < card_blocks; ++b) {
    const BlockSums& from = simulation.production_.blocks()[b];
    CardBlockSums& to = blocks[b];
    const auto put = [](double* place, const SymmetricTensor& t) {
      for (const double x : {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}) *place++ = x;
    };
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) put(to.sum + 6 * t, from.stress[t]);
    put(to.sum + card_motion, from.motion);
    to.sum[card_contacts] = from.contacts;
    to.sum[card_overlaps] = from.overlaps;
    to.steps = static_cast<double>(from.steps);
    to.samples = static_cast<double>(from.samples);
    put(to.structural, from.structural_brownian);
    to.translational = from.temperature.translational;
    to.rotational = from.temperature.rotational;
  }
  upload(own.blocks, blocks);

  CardProgress& at = slot.progress;
  at = {};
  at.seed = simulation.random_key_;
  at.status = system.step < slot.scene->scene.total ? CardStatus::runs : CardStatus::ended;
  at.finite = true;
  at.step = system.step;
  at.clock_origin = system.clock.origin;
  at.clock_steps = system.clock.steps;
  at.start_tilt = simulation.edges_at_start_.column[1].x;
  at.strain = system.box.strain();
  at.flips = system.box.basis().column[1].x;
  at.listed_strain = system.list.listed().displacement_gradient.column[1].x;
  at.found_strain = system.list.moment_of_candidates().displacement_gradient.column[1].x;
  at.displacement_bound = kept.displacement_bound;
  at.pairs = static_cast<std::uint32_t>(old_pairs.size());
  at.window_overlap = simulation.largest_overlap_;
  const StepErrors& errors = simulation.errors_;
  at.iterations = errors.solver_iterations;
  at.divided_steps = errors.divided_steps;
  at.deepest_division = errors.deepest_division;
  at.sum_of_residuals = errors.sum_of_solver_residuals;
  at.largest_residual = errors.largest_solver_residual;
  at.builds = 0;
  device_->upload(own.progress, &at, sizeof at);
}

void CardEnsemble::bring_home(Slot& slot) {
  Simulation& simulation = *slot.simulation;
  System& system = simulation.system_;
  ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  const CardRealisation& own = slot.own;
  const CardProgress& at = slot.progress;
  const bool noisy = simulation.scene_.physics.thermal_energy > 0;
  std::vector<CardRow> rows(count);
  const auto field = [&](const CardRow* from) {
    device_->download(rows.data(), from, count * sizeof(CardRow));
    VectorField result(count);
    for (std::size_t i = 0; i < count; ++i) result.set(i, {rows[i].x, rows[i].y, rows[i].z});
    return result;
  };
  particles.position = field(own.position);
  particles.velocity = field(own.velocity);
  particles.angular_velocity = field(own.spin);
  std::vector<std::array<std::int32_t, 4>> images(count);
  device_->download(images.data(), own.image, count * sizeof images[0]);
  for (std::size_t i = 0; i < count; ++i) particles.image[i] = {images[i][0], images[i][1], images[i][2]};
  Kept kept{VectorField(count), VectorField(count), at.displacement_bound};
  if (!noisy) {
    kept.velocity_change = field(own.velocity_change);
    kept.spin_change = field(own.spin_change);
  }
  give_back(*simulation.integrator_, kept, noisy);

  system.step = at.step;
  system.clock = {at.clock_origin, simulation.schedule_.timestep, at.clock_steps};
  BasisChange basis = system.box.basis();
  basis.column[1].x = at.flips;
  system.box.set_basis(basis);
  const std::uint64_t builds = system.list.builds() + at.builds;
  system.list.rebuild_from({field(own.found), simple_shear(at.found_strain)},
                           {field(own.listed), simple_shear(at.listed_strain)}, particles, system.box);
  system.list.set_builds(builds);
  slot.progress.builds = 0;
  system.box.deform(simple_shear(at.strain));

  system.springs = SpringField(system.springs.kinds(), system.list.pairs().size());
  if (slot.scene->scene.springs && at.pairs > 0) {
    std::vector<CardPair> pairs(at.pairs);
    device_->download(pairs.data(), own.pair, at.pairs * sizeof pairs[0]);
    std::vector<double> springs(components_of_card_springs * own.room.pairs);
    device_->download(springs.data(), at.swapped ? own.springs_after : own.springs,
                      springs.size() * sizeof(double));
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> by_ends;
    for (std::size_t p = 0; p < pairs.size(); ++p) by_ends[{pairs[p].first, pairs[p].second}].push_back(p);
    for (std::size_t p = 0; p < system.list.pairs().size(); ++p) {
      const Pair& pair = system.list.pairs()[p];
      const LatticeShift image = system.list.images()[pair.image];
      const auto found = by_ends.find({pair.first, pair.second});
      if (found == by_ends.end()) continue;
      for (const std::size_t k : found->second) {
        if (LatticeShift{pairs[k].image[0], pairs[k].image[1], pairs[k].image[2]} != image) continue;
        const auto value = [&](std::size_t c) { return springs[c * own.room.pairs + k]; };
        system.springs.set(p, {{value(0), value(1), value(2)}, {value(3), value(4), value(5)}, value(6)});
      }
    }
  }

  std::vector<CardBlockSums> blocks(card_blocks);
  device_->download(blocks.data(), own.blocks, blocks.size() * sizeof blocks[0]);
  std::array<BlockSums, count_of_blocks> sums = simulation.production_.blocks();
  for (std::size_t b = 0; b < card_blocks; ++b) {
    const CardBlockSums& from = blocks[b];
    BlockSums& to = sums[b];
    const auto get = [](const double* t) { return SymmetricTensor{t[0], t[1], t[2], t[3], t[4], t[5]}; };
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) to.stress[t] = get(from.sum + 6 * t);
    to.motion = get(from.sum + card_motion);
    to.contacts = from.sum[card_contacts];
    to.overlaps = from.sum[card_overlaps];
    to.steps = static_cast<std::uint64_t>(from.steps);
    to.shear_rate = from.steps * slot.scene->scene.rate;
    to.samples = static_cast<std::uint64_t>(from.samples);
    to.structural_brownian = get(from.structural);
    to.temperature = {from.translational, from.rotational};
  }
  simulation.production_.set_blocks(sums);
  simulation.largest_overlap_ = at.window_overlap;
  StepErrors& errors = simulation.errors_;
  errors.solver_iterations = at.iterations;
  errors.divided_steps = at.divided_steps;
  errors.deepest_division = at.deepest_division;
  errors.sum_of_solver_residuals = at.sum_of_residuals;
  errors.largest_solver_residual = at.largest_residual;
  slot.errors_at_home = errors;
}

void CardEnsemble::settle(Slot& slot) {
  Simulation& simulation = *slot.simulation;
  CardProgress& at = slot.progress;
  if (at.status == CardStatus::needs_room) {
    // Starts again from where it was last at home, in a larger slot. The list of the slot is half made.
    simulation.errors_ = slot.errors_at_home;
    slot.own.room = at_least(slot.own.room, slot.scene->room);
    place(slot);
  } else if (at.status == CardStatus::compares) {
    bring_home(slot);
    simulation.compare_half_steps();
    slot.errors_at_home = simulation.errors_;
    at.status = at.step == slot.scene->scene.total ? CardStatus::ended : CardStatus::runs;
    device_->upload(slot.own.progress, &at, sizeof at);
  }
}

std::optional<Ending> CardEnsemble::serve(Slot& slot) {
  settle(slot);
  Simulation& simulation = *slot.simulation;
  const CardProgress& at = slot.progress;
  if (at.status != CardStatus::ended) return std::nullopt;
  bring_home(slot);
  StepReport report;
  report.sums.largest_overlap = at.overlap;
  report.sums.finite = at.finite;
  report.largest_displacement = at.displacement;
  report.division = static_cast<int>(at.division);
  report.broke_off = at.broke_off;
  if (std::optional<Ending> ending =
          ending_of(report, simulation.system_, simulation.scene_.guard, simulation.smallest_radius_)) {
    return ending;
  }
  return Ending{Ending::Cause::completed, at.step, "the production window is complete"};
}

// Serves slots side by side, and takes out those that have ended.
void CardEnsemble::serve_all(const std::vector<Slot*>& slots, std::vector<Ended>& ended) {
  std::vector<std::optional<Ending>> endings(slots.size());
  std::vector<std::exception_ptr> faults(slots.size());  // which must not leave a thread of the loop
  for_each_index(slots.size(), omp_get_num_procs(), [&](std::size_t k) {
    try {
      endings[k] = serve(*slots[k]);
    } catch (...) {
      faults[k] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults) {
    if (fault) std::rethrow_exception(fault);
  }
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (!endings[k]) continue;
    ended.push_back({slots[k]->simulation, *endings[k]});
    std::erase_if(slots_, [&](const auto& slot) { return slot.get() == slots[k]; });
  }
}

std::vector<Ensemble::Ended> CardEnsemble::advance(std::chrono::duration<double> time) {
  std::map<unsigned, std::vector<Slot*>> by_variant;
  std::vector<Slot*> waiting;  // for the host
  for (const std::unique_ptr<Slot>& slot : slots_) {
    if (slot->progress.status == CardStatus::runs) {
      by_variant[slot->scene->variant].push_back(slot.get());
    } else {
      waiting.push_back(slot.get());
    }
  }
  const CardBounds bounds = {most_steps_, static_cast<std::uint64_t>(1e9 * time.count())};
  std::vector<std::unique_ptr<OwnedMemory>> arrays;
  for (const auto& [variant, slots] : by_variant) {
    std::vector<CardSlot> places;
    std::size_t particles = 0;
    for (const Slot* slot : slots) {
      places.push_back({reinterpret_cast<const CardScene*>(slot->scene->memory->get()), slot->own});
      particles = std::max(particles, slot->simulation->system_.particles.count());
    }
    arrays.push_back(std::make_unique<OwnedMemory>(*device_, places.size() * sizeof places[0]));
    std::byte* const array = arrays.back()->get();
    device_->upload(array, places.data(), places.size() * sizeof places[0]);
    device_->begin(variant, particles, reinterpret_cast<const CardSlot*>(array), places.size(), bounds);
  }
  // Meanwhile the host serves those that wait for it.
  std::vector<Ended> ended;
  std::exception_ptr fault;
  try {
    serve_all(waiting, ended);
  } catch (...) {
    fault = std::current_exception();
  }
  device_->finish();  // before memory that the device reads is released
  if (fault) std::rethrow_exception(fault);
  for (const auto& [variant, slots] : by_variant) {
    for (Slot* slot : slots) {
      device_->download(&slot->progress, slot->own.progress, sizeof(CardProgress));
      if (slot->progress.status != CardStatus::needs_room) continue;
      const CardRoom twice = {2 * slot->own.room.pairs, 2 * slot->own.room.neighbours};
      slot->scene->room = at_least(slot->scene->room, twice);
    }
  }
  // An ended realisation leaves in the same call: a state without its ending could not be brought home.
  waiting.clear();
  for (const auto& [variant, slots] : by_variant) {
    for (Slot* slot : slots) {
      if (slot->progress.status == CardStatus::ended) waiting.push_back(slot);
    }
  }
  serve_all(waiting, ended);
  return ended;
}

CardEnsemble::Slot& CardEnsemble::slot_of(const Simulation& simulation) {
  const auto found =
      std::ranges::find_if(slots_, [&](const auto& slot) { return slot->simulation == &simulation; });
  if (found == slots_.end()) throw std::logic_error("the realisation is not on the card");
  return **found;
}

void CardEnsemble::remove(Simulation& simulation) {
  Slot& slot = slot_of(simulation);
  settle(slot);
  bring_home(slot);
  std::erase_if(slots_, [&](const auto& other) { return other.get() == &slot; });
}

std::uint64_t CardEnsemble::steps_made(const Simulation& simulation) const {
  return progress(simulation).step;
}

const CardProgress& CardEnsemble::progress(const Simulation& simulation) const {
  return const_cast<CardEnsemble*>(this)->slot_of(simulation).progress;
}

}  // namespace peclet::engine
