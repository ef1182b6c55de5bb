#include "engine/state/neighbour_list.h"

#include <Eigen/SVD>
#include <atomic>
#include <bit>
#include <optional>
#include <stdexcept>
#include <utility>

#include "engine/state/cell_grid.h"
#include "engine/state/eigen_arrays.h"
#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

// Returns the smallest singular value of 1 + D; in simple shear by g it is sqrt(1 + g^2/4) - |g|/2.
double smallest_stretch(const Matrix3& displacement_gradient) {
  const double strain = displacement_gradient.column[1].x;
  if (displacement_gradient == simple_shear(strain)) {
    return std::sqrt(1 + 0.25 * strain * strain) - 0.5 * std::abs(strain);
  }
  return Eigen::JacobiSVD<Eigen::Matrix3d>(to_eigen(identity() + displacement_gradient)).singularValues()[2];
}

// Returns the displacement gradient since then, relative to the cell as it was: (D' - D) (1 + D)^-1.
Matrix3 change_since(const ListMoment& then, const PeriodicCell& box) {
  return (box.displacement_gradient() - then.displacement_gradient) *
         inverse(identity() + then.displacement_gradient);
}

double largest_displacement(const ListMoment& then, const ParticleState& particles, const PeriodicCell& box,
                            int threads) {
  const Matrix3 gradient = change_since(then, box);
  std::atomic<double> largest = 0;
  for_each_range(particles.count(), threads, [&](std::size_t begin, std::size_t end) {
    double own = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3 from = then.position[i];
      const Vector3 way = particles.position[i] - from - gradient * from;
      own = std::max(own, dot(way, way));
    }
    for (double seen = largest; own > seen && !largest.compare_exchange_weak(seen, own);) {
    }
  });
  return std::sqrt(largest);
}

}  // namespace

// Finds and arranges the pairs of a neighbour list.
//
// Each size class has a grid of its own, with cells as wide as the reach of two of its spheres. If there are
// more than four classes, those whose ranges are within a factor of 1.3 share a grid and form a band. A
// particle searches the grids of its own band and of larger ones: small spheres do not pay for the reach of
// large ones, and large ones do not search the fine grids of small ones.
class ListBuilder {
 public:
  // `box` is the cell at the moment of the positions that are searched.
  ListBuilder(NeighbourList& list, const ParticleState& particles, const PeriodicCell& box, int threads)
      : list_(list), particles_(particles), box_(box), threads_(threads) {}

  // Sets the blocks, and returns the pairs of each that are closer than their reach with this skin.
  std::vector<std::vector<FoundPair>> find(const VectorField& position, double skin) {
    skin_ = skin;
    set_grids(position);
    const std::size_t count = particles_.count(), blocks = count_of_particle_blocks(count);
    list_.blocks_.clear();
    for (std::size_t b = 0; b < blocks; ++b) {
      list_.blocks_.push_back({static_cast<std::uint32_t>(count * b / blocks),
                               static_cast<std::uint32_t>(count * (b + 1) / blocks), 0, 0, 0, 0});
    }
    found_.resize(blocks);
    for_each_index(blocks, threads_, [&](std::size_t b) { search(b); });
    if (meets_itself_) {
      throw std::invalid_argument("the box is so small that a particle interacts with its own image");
    }
    deliver_strays();
    return std::move(found_);
  }

  void arrange(const std::vector<std::vector<FoundPair>>& found) {
    number_images(found);
    list_.runs_.clear();
    runs_.resize(found.size());
    std::uint32_t pairs = 0;
    for (std::size_t b = 0; b < found.size(); ++b) {
      list_.blocks_[b].runs_begin = pairs;  // the first pair, until collect_incoming() sets the first run
      pairs += static_cast<std::uint32_t>(found[b].size());
    }
    list_.pairs_.resize(pairs);
    for_each_index(found.size(), threads_, [&](std::size_t b) { arrange(b, found[b]); });
    collect_incoming();
  }

  // Returns the candidates that are closer than their reach at the positions of the list.
  std::vector<std::vector<FoundPair>> near_ones(const std::vector<std::vector<FoundPair>>& candidates) const {
    std::vector<double> squared_reach;  // for each kind
    const std::size_t classes = list_.ranges_.classes();
    for (std::size_t kind = 0; kind < classes * classes; ++kind) {
      const double reach = list_.reach(list_.ranges_.at(kind / classes, kind % classes), list_.skin_);
      squared_reach.push_back(reach * reach);
    }
    std::vector<std::vector<FoundPair>> near(candidates.size());
    const VectorField& position = list_.listed_.position;
    for_each_index(candidates.size(), threads_, [&](std::size_t b) {
      near[b].reserve(candidates[b].size());
      for (const FoundPair& pair : candidates[b]) {
        Vector3 way = position[pair.second] - position[pair.first];
        if (pair.image != LatticeShift{}) way += box_.displacement(pair.image);
        if (dot(way, way) < squared_reach[pair.kind]) near[b].push_back(pair);
      }
    });
    return near;
  }

 private:
  using Found = FoundPair;
  using Away = FoundPair::Away;

  // Assigns the size classes to bands and sets their reaches.
  void set_bands() {
    constexpr std::size_t few = 4;
    constexpr double alike = 1.3;
    const RangeTable& ranges = list_.ranges_;
    const std::size_t classes = ranges.classes();
    band_of_.clear();
    std::size_t first = 0, bands = 0;  // `first`: the first class of the last band
    for (std::size_t c = 0; c < classes; ++c) {
      const bool joins = c > 0 && classes > few && ranges.at(c, c) <= alike * ranges.at(first, first);
      if (!joins) {
        first = c;
        ++bands;
      }
      band_of_.push_back(bands - 1);
    }
    reach_.assign(classes * classes, 0);
    widest_reach_.assign(classes * bands, 0);
    for (std::size_t own = 0; own < classes; ++own) {
      for (std::size_t other = own; other < classes; ++other) {
        const double reach = list_.reach(ranges.at(own, other), skin_);
        reach_[own * classes + other] = reach;
        double& widest = widest_reach_[own * bands + band_of_[other]];
        widest = std::max(widest, reach);
      }
    }
  }

  void set_grids(const VectorField& position) {
    set_bands();
    places_ = lattice_places(position, box_);
    const std::size_t classes = band_of_.size(), bands = classes == 0 ? 0 : band_of_.back() + 1;
    std::vector<std::vector<std::uint32_t>> members(bands);
    for (std::uint32_t i = 0; i < particles_.count(); ++i) {
      members[band_of_[particles_.size_class[i]]].push_back(i);
    }
    for (std::size_t band = 0; band < bands; ++band) {
      double widest = 0;
      for (std::size_t own = 0; own < classes; ++own) {
        widest = std::max(widest, widest_reach_[own * bands + band]);
      }
      grids_.emplace_back();
      if (!members[band].empty()) grids_.back().emplace(places_, members[band], box_, widest);
    }
  }

  void search(std::size_t block) {
    const ParticleBlock& home = list_.blocks_[block];
    std::vector<Found>& found = found_[block];
    for (std::uint32_t i = home.begin; i < home.end; ++i) search_near(i, found);
  }

  void search_near(std::uint32_t i, std::vector<Found>& found) {
    const std::size_t own = particles_.size_class[i], classes = band_of_.size(), bands = grids_.size();
    const double range = list_.ranges_.at(own, own);
    for (std::size_t band = band_of_[own]; band < bands; ++band) {
      if (!grids_[band]) continue;
      grids_[band]->visit_near(places_.fractional[i], widest_reach_[own * bands + band],
                               [&](std::uint32_t j, LatticeShift wrap, const Vector3& separation) {
                                 const std::size_t other = particles_.size_class[j];
                                 if (other < own || (other == own && j < i)) {
                                   return;  // found from j
                                 }
                                 const double squared = dot(separation, separation);
                                 const double reach = reach_[own * classes + other];
                                 if (!(squared < reach * reach)) return;
                                 if (j == i) {
                                   if (wrap != LatticeShift{} && squared < range * range) {
                                     meets_itself_ = true;
                                   }
                                   return;
                                 }
                                 found.push_back(make(i, j, wrap + places_.offset[i] - places_.offset[j]));
                               });
    }
  }

  Found make(std::uint32_t i, std::uint32_t j, LatticeShift image) const {
    if (particles_.id[i] > particles_.id[j]) {
      std::swap(i, j);
      image = LatticeShift{} - image;
    }
    const std::size_t kind = particles_.size_class[i] * list_.ranges_.classes() + particles_.size_class[j];
    const std::uint32_t of_first = block_of(i), of_second = block_of(j);
    const Away away = of_first == of_second ? Away::none : of_first < of_second ? Away::first : Away::second;
    return {i, j, std::max(of_first, of_second), image, static_cast<std::uint16_t>(kind), away};
  }

  std::uint32_t block_of(std::uint32_t particle) const {
    const std::size_t blocks = list_.blocks_.size();
    if (blocks == 1) return 0;
    // Block b begins at count b / blocks, rounded down: the estimate is right or one too small.
    std::size_t block = particle * blocks / particles_.count();
    while (particle >= list_.blocks_[block].end) ++block;
    return static_cast<std::uint32_t>(block);
  }

  // Moves crossing pairs that were found from the earlier block to the later one.
  void deliver_strays() {
    if (found_.size() == 1) return;
    std::vector<std::vector<Found>> strays(found_.size());
    for_each_index(found_.size(), threads_, [&](std::size_t b) {
      const auto home = [b](const Found& pair) { return pair.block == b; };
      const auto away = std::stable_partition(found_[b].begin(), found_[b].end(), home);
      strays[b].assign(away, found_[b].end());
      found_[b].erase(away, found_[b].end());
    });
    for (const std::vector<Found>& from_block : strays) {
      for (const Found& pair : from_block) found_[pair.block].push_back(pair);
    }
  }

  void number_images(const std::vector<std::vector<Found>>& all) {
    const auto add = [](std::vector<LatticeShift>& images, LatticeShift image) {
      if (image != images.back() && std::ranges::find(images, image) == images.end()) images.push_back(image);
    };
    std::vector<std::vector<LatticeShift>> of_block(all.size(), {LatticeShift{}});
    for_each_index(all.size(), threads_, [&](std::size_t b) {
      for (const Found& pair : all[b]) add(of_block[b], pair.image);
    });
    list_.images_.assign(1, LatticeShift{});
    for (const std::vector<LatticeShift>& images : of_block) {
      for (const LatticeShift image : images) add(list_.images_, image);
    }
  }

  std::uint16_t image_number(LatticeShift image) const {
    return static_cast<std::uint16_t>(std::find(list_.images_.begin(), list_.images_.end(), image) -
                                      list_.images_.begin());
  }

  // Sorts the pairs of a block into runs by counting. Pairs of a run keep the order in which they were found.
  void arrange(std::size_t block, const std::vector<Found>& found) {
    const std::size_t part = 2 * list_.ranges_.classes() * list_.ranges_.classes(), buckets = 3 * part;
    std::vector<std::uint32_t> next(buckets + 1);
    for (const Found& pair : found) ++next[bucket(pair) + 1];
    next[0] = list_.blocks_[block].runs_begin;
    for (std::size_t k = 0; k < buckets; ++k) {
      next[k + 1] += next[k];
      if (next[k + 1] > next[k]) {
        const auto away = static_cast<Away>(k / part);
        runs_[block].push_back({next[k], next[k + 1], away == Away::none ? within_block : 0,
                                static_cast<std::uint16_t>(k % part / 2), k % 2 == 1, away == Away::first});
      }
    }
    for (const Found& pair : found) {
      list_.pairs_[next[bucket(pair)]++] = {pair.first, pair.second, image_number(pair.image), pair.kind};
    }
  }

  void collect_incoming() {
    std::uint32_t crossings = 0;
    for (std::size_t b = 0; b < runs_.size(); ++b) {
      list_.blocks_[b].runs_begin = static_cast<std::uint32_t>(list_.runs_.size());
      for (PairRun& run : runs_[b]) {
        if (run.crossing != within_block) {
          run.crossing = crossings;
          crossings += run.end - run.begin;
        }
        list_.runs_.push_back(run);
      }
      list_.blocks_[b].runs_end = static_cast<std::uint32_t>(list_.runs_.size());
    }
    list_.incoming_.clear();
    if (crossings == 0) return;
    std::vector<std::uint32_t> next(list_.blocks_.size() + 1);
    const auto for_each_crossing = [&](auto&& use) {
      for (const PairRun& run : list_.runs_) {
        for (std::uint32_t p = run.begin; run.crossing != within_block && p < run.end; ++p) {
          const Pair& pair = list_.pairs_[p];
          use(run.first_is_away ? pair.first : pair.second, run.crossing + (p - run.begin));
        }
      }
    };
    for_each_crossing([&](std::uint32_t away, std::uint32_t) { ++next[block_of(away) + 1]; });
    for (std::size_t b = 0; b < list_.blocks_.size(); ++b) {
      next[b + 1] += next[b];
      list_.blocks_[b].incoming_begin = next[b];
      list_.blocks_[b].incoming_end = next[b + 1];
    }
    list_.incoming_.resize(crossings);
    for_each_crossing([&](std::uint32_t away, std::uint32_t crossing) {
      list_.incoming_[next[block_of(away)]++] = {away, crossing};
    });
  }

  std::size_t bucket(const Found& pair) const {
    const std::size_t kinds = list_.ranges_.classes() * list_.ranges_.classes();
    return (static_cast<std::size_t>(pair.away) * kinds + pair.kind) * 2 +
           (pair.image == LatticeShift{} ? 0 : 1);
  }

  NeighbourList& list_;
  const ParticleState& particles_;
  const PeriodicCell& box_;
  int threads_;
  double skin_ = 0;
  LatticePlaces places_;
  std::vector<std::size_t> band_of_;  // for each class
  std::vector<double> reach_,
      widest_reach_;  // for each class with each larger one; the largest one with those of each band
  std::vector<std::optional<CellGrid>> grids_;  // for each band; empty without members
  std::vector<std::vector<Found>> found_;       // for each block
  std::vector<std::vector<PairRun>> runs_;
  std::atomic<bool> meets_itself_ = false;  // exceptions must not leave a thread of the loop
};

std::size_t count_of_particle_blocks(std::size_t particles) {
  return std::bit_ceil((particles + most_particles_per_block - 1) / most_particles_per_block);
}

void NeighbourList::build(const ParticleState& particles, const PeriodicCell& box, int threads) {
  const ListMoment now = {particles.position, box.displacement_gradient()};
  rebuild_from(now, now, particles, box, threads);
  ++builds_;
}

void NeighbourList::rebuild_from(ListMoment candidates, ListMoment listed, const ParticleState& particles,
                                 PeriodicCell box, int threads) {
  found_ = std::move(candidates);
  box.deform(found_.displacement_gradient);
  ListBuilder builder(*this, particles, box, threads);
  if (keeps_candidates()) {
    candidates_ = builder.find(found_.position, skin_of_candidates_);
    listed_ = std::move(listed);
    box.deform(listed_.displacement_gradient);
    list_candidates(particles, box, threads);
  } else {
    listed_ = std::exchange(found_, {});
    builder.arrange(builder.find(listed_.position, skin_));
  }
}

bool NeighbourList::can_narrow(const ParticleState& particles, const PeriodicCell& box, int threads) const {
  return keeps_candidates() && !candidates_.empty() &&
         engine::largest_displacement(found_, particles, box, threads) <
             allowed_displacement(found_, skin_of_candidates_, skin_, box);
}

void NeighbourList::narrow(const ParticleState& particles, const PeriodicCell& box, int threads) {
  listed_ = {particles.position, box.displacement_gradient()};
  list_candidates(particles, box, threads);
  ++builds_;
}

void NeighbourList::list_candidates(const ParticleState& particles, const PeriodicCell& box, int threads) {
  ListBuilder builder(*this, particles, box, threads);
  builder.arrange(builder.near_ones(candidates_));
}

double NeighbourList::reach(double range, double skin) const {
  constexpr double share_of_strain = 0.1;
  const double smallest = ranges_.smallest();
  return range + skin * (smallest + share_of_strain * (range - smallest));
}

double NeighbourList::allowed_displacement(const ListMoment& then, double skin, double inner_skin,
                                           const PeriodicCell& box) const {
  const double stretch = smallest_stretch(change_since(then, box));
  // The result is linear in the range: the smallest or the largest range decides.
  const auto left = [&](double range) {
    return 0.5 * (stretch * reach(range, skin) - reach(range, inner_skin));
  };
  return std::min(left(ranges_.smallest()), left(ranges_.largest()));
}

double NeighbourList::allowed_displacement(const PeriodicCell& box) const {
  constexpr double none = 0;
  return allowed_displacement(listed_, skin_, none, box);
}

double NeighbourList::largest_displacement(const ParticleState& particles, const PeriodicCell& box,
                                           int threads) const {
  return engine::largest_displacement(listed_, particles, box, threads);
}

bool NeighbourList::holds(const ParticleState& particles, const PeriodicCell& box) const {
  return largest_displacement(particles, box) < allowed_displacement(box);
}

}  // namespace peclet::engine
