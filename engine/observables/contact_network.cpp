// Measures the contacts of the spheres and the mobilisation of their friction.
//
// `contacts` is the share of the particles with 0, 1, ... 11 and with 12 or more contacts. With friction,
// mobilised_friction is the mean over contacts of |F_t| / (mu F_n), with the force F_t of spring and dashpot
// and F_n = frictional_load(), usually k_n delta. `mobilisation` is its distribution: the share of contacts
// in each twentieth from 0 to 1. sliding_contacts is the share of contacts that slide (TouchingPair). With a
// critical load these means are over contacts above it, and frictional_contacts is their share. Without
// contacts they are null.
#include <algorithm>

#include "engine/observables/observable.h"
#include "engine/observables/structure.h"

namespace peclet::engine {
namespace {

// The number of classes of particles, by contacts (the last class is open), and of contacts, by mobilisation.
constexpr std::size_t counts_of_contacts = 13, parts_of_mobilisation = 20;

constexpr const char *mobilised_name = "mobilised_friction", *sliding_name = "sliding_contacts",
                     *frictional_name = "frictional_contacts";

class ContactNetwork : public Observable {
 public:
  explicit ContactNetwork(const Plan& plan)
      : Observable(plan), contact_(*plan.scene.physics.contact), kinds_(pair_kinds_in(plan.scene)) {}

  void sample(const System& system, std::size_t block) override {
    std::vector<std::size_t> touching(system.particles.count());
    for_each_touching_pair(system, kinds_, contact_, [&](const TouchingPair& contact) {
      ++touching[contact.pair.first];
      ++touching[contact.pair.second];
      if (contact_.friction > 0) add_contact(block, contact);
    });
    for (const std::size_t contacts : touching) {
      contacts_.add(block, std::min<std::size_t>(contacts, counts_of_contacts - 1), 1);
    }
    contacts_.weigh(block, static_cast<double>(system.particles.count()));
  }

 private:
  void add_contact(std::size_t block, const TouchingPair& contact) {
    frictional_.add(block, 0, contact.rough ? 1 : 0);
    frictional_.weigh(block, 1);
    if (!contact.rough) return;
    const auto part = static_cast<std::size_t>(parts_of_mobilisation * std::min(contact.mobilised, 1.0));
    mobilisation_.add(block, std::min<std::size_t>(part, parts_of_mobilisation - 1), 1);
    mobilised_.add(block, 0, contact.mobilised);
    sliding_.add(block, 0, contact.slides ? 1 : 0);
    for (BlockedMean* const mean : {&mobilisation_, &mobilised_, &sliding_}) mean->weigh(block, 1);
  }
  BlockedMean& if_rough(const Quantity& quantity) { return mean_if(contact_.friction > 0, quantity); }

  ContactParameters contact_;
  std::vector<PairKind> kinds_;
  BlockedMean& contacts_ =
      mean({.name = "contact_network/contacts",
            .symbol = "P(Z)",
            .unit = "1",
            .axes = {axis_of("contacts", "1", counts_of_contacts, [](std::size_t k) { return k; })}});
  BlockedMean& mobilisation_ =
      if_rough({.name = "contact_network/mobilisation",
                .symbol = "P(|F_t| / (μ F_n))",
                .unit = "1",
                .axes = {axis_of("mobilisation", "1", parts_of_mobilisation, [](std::size_t k) {
                  return (static_cast<double>(k) + 0.5) / parts_of_mobilisation;
                })}});
  BlockedMean& mobilised_ = if_rough({.name = mobilised_name, .symbol = "⟨|F_t| / (μ F_n)⟩", .unit = "1"});
  BlockedMean& sliding_ =
      if_rough({.name = sliding_name,
                .symbol = remembers_sliding(contact_) ? "P(slides)" : "P(|F_t| > 0.99 μ F_n)",
                .unit = "1"});
  BlockedMean& frictional_ = mean_if(contact_.friction > 0 && contact_.critical_load > 0,
                                     {.name = frictional_name, .symbol = "P(F_n > F_CL)", .unit = "1"});
};

}  // namespace

ObservableKind contact_network() {
  return {.name = "contact_network",
          .meaning = "number of contacts of a particle, and mobilised friction",
          .numbers = {mobilised_name, sliding_name, frictional_name},
          .read = [](const SceneDocument& document, const Scene& scene) {
            if (!scene.physics.contact) {
              document.refuse("/observables", "must not list contact_network without /contact");
            }
            return maker<ContactNetwork>();
          }};
}

}  // namespace peclet::engine
