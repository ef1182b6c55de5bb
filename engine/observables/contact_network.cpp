#include "engine/observables/contact_network.h"

#include <algorithm>

namespace peclet::engine {
namespace {

// Particles by their contacts, the last with as many or more; contacts by equal parts of their mobilisation.
constexpr std::size_t counts_of_contacts = 13, parts_of_mobilisation = 20;

std::vector<Quantity> network_quantities(const Scene& scene, const Window&) {
  Axis contacts{"contacts", "1", Json::array()}, mobilisation{"mobilisation", "1", Json::array()};
  for (std::size_t k = 0; k < counts_of_contacts; ++k) contacts.values.push_back(k);
  for (std::size_t k = 0; k < parts_of_mobilisation; ++k) {
    mobilisation.values.push_back((static_cast<double>(k) + 0.5) / parts_of_mobilisation);
  }
  std::vector<Quantity> all{
      {.name = "contact_network/contacts", .symbol = "P(Z)", .unit = "1", .axes = {contacts}}};
  if (!(scene.physics.contact->friction > 0)) return all;
  all.push_back({.name = "contact_network/mobilisation",
                 .symbol = "P(|F_t| / (μ F_n))",
                 .unit = "1",
                 .axes = {mobilisation}});
  all.push_back({.name = "mobilised_friction", .symbol = "⟨|F_t| / (μ F_n)⟩", .unit = "1"});
  const bool remembered = remembers_sliding(*scene.physics.contact);
  all.push_back({.name = "sliding_contacts",
                 .symbol = remembered ? "P(slides)" : "P(|F_t| > 0.99 μ F_n)",
                 .unit = "1"});
  if (scene.physics.contact->critical_load > 0) {
    all.push_back({.name = "frictional_contacts", .symbol = "P(F_n > F_CL)", .unit = "1"});
  }
  return all;
}

}  // namespace

ContactNetwork::ContactNetwork(const Scene& scene, const System& system, const Window& window)
    : Observable(interval_of(scene, contact_network(), window)),
      contact_(*scene.physics.contact),
      kinds_(make_pair_kinds(scene.physics, distinct_radii(system.particles.radius))),
      by_contacts_(counts_of_contacts),
      by_mobilisation_(parts_of_mobilisation) {}

void ContactNetwork::sample(const System& system, std::size_t block) {
  std::vector<std::size_t> touching(system.particles.count());
  for_each_touching_pair(system, kinds_, contact_, [&](const TouchingPair& contact) {
    ++touching[contact.pair.first];
    ++touching[contact.pair.second];
    if (contact_.friction > 0) add_contact(block, contact);
  });
  for (const std::size_t contacts : touching) {
    by_contacts_.add(block, std::min<std::size_t>(contacts, counts_of_contacts - 1), 1);
  }
  by_contacts_.weigh(block, static_cast<double>(system.particles.count()));
}

void ContactNetwork::add_contact(std::size_t block, const TouchingPair& contact) {
  frictional_contacts_.add(block, 0, contact.rough ? 1 : 0);
  frictional_contacts_.weigh(block, 1);
  if (!contact.rough) return;
  const double mobilised = contact.mobilised;
  const auto part = static_cast<std::size_t>(parts_of_mobilisation * std::min(mobilised, 1.0));
  by_mobilisation_.add(block, std::min<std::size_t>(part, parts_of_mobilisation - 1), 1);
  by_mobilisation_.weigh(block, 1);
  mobilised_friction_.add(block, 0, mobilised);
  mobilised_friction_.weigh(block, 1);
  sliding_contacts_.add(block, 0, contact.slides ? 1 : 0);
  sliding_contacts_.weigh(block, 1);
}

void ContactNetwork::add_to(Json& mean) const {
  mean["contact_network"]["contacts"] = by_contacts_.value();
  if (!(contact_.friction > 0)) return;
  mean["contact_network"]["mobilisation"] = by_mobilisation_.value();
  mean["mobilised_friction"] = mobilised_friction_.value();
  mean["sliding_contacts"] = sliding_contacts_.value();
  if (contact_.critical_load > 0) mean["frictional_contacts"] = frictional_contacts_.value();
}

void ContactNetwork::add_blocks_to(Json& blocks) const {
  blocks["contact_network"]["contacts"] = by_contacts_.blocks();
  if (!(contact_.friction > 0)) return;
  blocks["contact_network"]["mobilisation"] = by_mobilisation_.blocks();
  blocks["mobilised_friction"] = mobilised_friction_.blocks();
  blocks["sliding_contacts"] = sliding_contacts_.blocks();
  if (contact_.critical_load > 0) blocks["frictional_contacts"] = frictional_contacts_.blocks();
}

void ContactNetwork::save(ArchiveWriter& archive) const {
  for (const BlockedMean* mean :
       {&by_contacts_, &by_mobilisation_, &mobilised_friction_, &sliding_contacts_, &frictional_contacts_}) {
    mean->save(archive);
  }
}

void ContactNetwork::load(ArchiveReader& archive) {
  for (BlockedMean* mean :
       {&by_contacts_, &by_mobilisation_, &mobilised_friction_, &sliding_contacts_, &frictional_contacts_}) {
    mean->load(archive);
  }
}

ObservableKind contact_network() {
  return {"contact_network", seldom, [](const Scene&, const Window&, const std::string&) {},
          network_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<ContactNetwork>(scene, system, window);
          }};
}

}  // namespace peclet::engine
