// Who touches whom, and how hard friction works.
//
// `contacts` is the share of the particles with 0, 1, ... 11 and with 12 or more contacts. With friction,
// mobilised_friction is the mean of |F_t| / (mu F_n) over contacts, F_t = k_t s of the sliding spring, F_n =
// k_n delta; `mobilisation` is its distribution, the share of contacts in each twentieth from 0 to 1; and
// sliding_contacts is the share of those above 0.99. Null where there was no contact at all.
#pragma once

#include <array>
#include <vector>

#include "engine/kernels/pairs/pair_kinds.h"
#include "engine/observables/observable.h"
#include "engine/scene/scene.h"
#include "engine/terms/contact.h"

namespace peclet::engine {

class ContactNetwork : public Observable {
 public:
  // Requires contacts in the scene.
  ContactNetwork(const Scene& scene, const System& system, std::uint64_t interval);

  void sample(const System& system) override;
  void add_to(Json& mean) const override;
  void save(ArchiveWriter& archive) const override { archive.put(sums_); }
  void load(ArchiveReader& archive) override { sums_ = archive.get<Sums>(); }

 private:
  struct Sums {
    std::uint64_t particles = 0, contacts = 0, sliding = 0;
    double mobilised = 0;
    std::array<std::uint64_t, 13> by_contacts{};
    std::array<std::uint64_t, 20> by_mobilisation{};
  };

  ContactParameters contact_;
  std::vector<PairKind> kinds_;
  Sums sums_;
};

}  // namespace peclet::engine
