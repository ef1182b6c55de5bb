// Mean squared displacements over lags from one sample to seven sixteenths of the window.
//
//   x(t) = < (x_i(s + t) - x_i(s))^2 >, y and z likewise,
//
// the mean over particles i of a species (or all) and origins s, of unwrapped places in the laboratory frame
// and in units of length squared. `centre` is the same of the mean displacement of all particles: that of the
// suspension as a whole, which is no diffusion of one particle in it. Under shear the flow carries particles
// along x, and that direction is left out.
//
// Lags are k 2^l samples: k = 1 ... 7 for l = 0 and 4 ... 7 beyond, with origins 2^l samples apart, so that
// cost per sample does not grow with the window. Memory: 192 bytes for each particle and level.
//
// self_diffusion is the slope between the two longest lags t and 2 t, in three dimensions, relative to the
// centre, over that of a free sphere of the reference radius a,
//   D_0 = kT / (pi eta a)   (Li's thesis, ch. 4; three times the one-dimensional kT / (3 pi eta a));
// null without temperature. Under shear it is 3/2 of that of y and z.
#pragma once

#include <array>
#include <vector>

#include "engine/observables/kinds.h"

namespace peclet::engine {

constexpr std::size_t kept_places = 8;  // of each level

class MeanSquaredDisplacement : public Observable {
 public:
  // Requires 8 samples in the window.
  MeanSquaredDisplacement(const Scene& scene, const System& system, const Window& window);

  void sample(const System& system, std::size_t block) override;
  void add_to(Json& mean) const override;
  void add_blocks_to(Json&) const override {}
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

 private:
  struct Sum {  // over origins, of one lag
    std::uint64_t origins = 0;
    Vector3 centre;  // squares of the mean displacement
  };
  struct Level {
    std::uint64_t pushed = 0;
    std::array<std::vector<Vector3>, kept_places> places;  // by id; a ring
    std::array<Sum, kept_places> sums{};                   // by k
    std::vector<Vector3> squares;  // by k and size class: sums over particles and origins
  };
  // One line of the result.
  struct Lag {
    std::uint64_t samples;
    const Level* level;
    std::size_t k;
  };

  std::size_t classes() const { return count_of_class_.size(); }
  void push(Level& level, std::size_t first_lag, const std::vector<Vector3>& places);
  void add(Level& level, std::size_t k, const std::vector<Vector3>& from, const std::vector<Vector3>& to);
  std::vector<Lag> lags() const;
  Vector3 of_all(const Lag& lag) const;
  Vector3 of_class(const Lag& lag, std::size_t size_class) const;
  Json axes(const std::vector<Vector3>& values) const;
  Json self_diffusion(const std::vector<Lag>& lags) const;

  double time_;  // between samples
  bool sheared_;
  double free_slope_;  // D_0; 0 without temperature
  std::vector<double> radius_of_class_;
  std::vector<double> count_of_class_;
  std::vector<std::uint16_t> class_of_;  // by id
  std::uint64_t samples_ = 0;
  std::vector<Level> levels_;
};

}  // namespace peclet::engine
