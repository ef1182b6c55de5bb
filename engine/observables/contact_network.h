// Who touches whom, and how hard friction works.
//
// `contacts` is the share of the particles with 0, 1, ... 11 and with 12 or more contacts. With friction,
// mobilised_friction is the mean of |F_t| / (mu F_n) over contacts, F_t = k_t s of the sliding spring, F_n =
// frictional_load(), k_n delta as a rule; `mobilisation` is its distribution, the share of contacts in each
// twentieth from 0 to 1; and sliding_contacts is the share of those above 0.99. With a critical load these
// are of the contacts above it, and frictional_contacts is their share. Null where there was no such contact.
#pragma once

#include <vector>

#include "engine/averages/blocked_mean.h"
#include "engine/kernels/pairs/pair_kinds.h"
#include "engine/observables/kinds.h"
#include "engine/observables/touching_pairs.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

class ContactNetwork : public Observable {
 public:
  // Requires contacts in the scene.
  ContactNetwork(const Scene& scene, const System& system, const Window& window);

  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json& blocks) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  void add_contact(std::size_t block, const TouchingPair& contact);

  ContactParameters contact_;
  std::vector<PairKind> kinds_;
  BlockedMean by_contacts_, by_mobilisation_;
  BlockedMean mobilised_friction_, sliding_contacts_, frictional_contacts_;
};

}  // namespace peclet::engine
