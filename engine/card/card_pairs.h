// CardPairs lays out spheres and their listed pairs for kernels for cards, in the memory of the processor.
#pragma once

#include "engine/card/card_forces.h"
#include "engine/card/card_setup.h"

namespace peclet::engine {

class CardPairs {
 public:
  // The images of the list have components of at most 127 (has_room_for()). The cell is that of steady shear.
  // `particles` are used as long as the object is.
  CardPairs(const Physics& physics, const ParticleState& particles, const NeighbourList& list,
            const PeriodicCell& box);
  CardPairs(const CardPairs&) = delete;
  CardPairs& operator=(const CardPairs&) = delete;

  // True if CardPair has room for an image.
  static bool has_room_for(const LatticeShift& image);

  void set_springs(const SpringField& springs);
  // Sets springs to those after the last evaluation.
  void get_springs_after(SpringField& springs) const;

  const CardScene& scene() const { return scene_; }
  const CardRealisation& own() const { return own_; }
  const CardProgress& progress() const { return progress_; }

  template <Terms terms>
  typename CardForces<terms>::Moment moment(const CardLevel& level) const {
    return {level, cell_, own_.velocity, own_.spin};
  }

 private:
  std::vector<PairKind> kinds_;
  std::vector<CardSize> sizes_;
  CardScene scene_{};
  CardRealisation own_{};
  CardProgress progress_{};
  CardCell cell_{};
  struct alignas(256) Bytes {
    std::byte byte[256];
  };
  std::vector<Bytes> memory_;
};

}  // namespace peclet::engine
