#include "engine/state/neighbour_list.h"

#include <algorithm>
#include <stdexcept>

#include "engine/state/cell_grid.h"

namespace peclet::engine {
namespace {

// Smallest singular value of [[1, g], [0, 1]]: sqrt(1 + g^2/4) - |g|/2.
double smallest_stretch(double strain) {
  return std::sqrt(1 + 0.25 * strain * strain) - 0.5 * std::abs(strain);
}

}  // namespace

double RangeTable::largest() const { return *std::max_element(range_.begin(), range_.end()); }

void NeighbourList::build(const ParticleState& particles, const ShearedBox& box) {
  rebuild_from(particles.position, particles, box);
  ++builds_;
}

void NeighbourList::rebuild_from(VectorField reference, const ParticleState& particles,
                                 const ShearedBox& box) {
  reference_ = std::move(reference);
  strain_at_build_ = box.strain();
  pairs_.clear();
  images_.assign(1, LatticeShift{});
  const CellGrid grid(reference_, box, ranges_.largest() + skin_);
  std::vector<CellGrid::Neighbour> near;
  for (std::uint32_t i = 0; i < particles.count(); ++i) {
    near.clear();
    grid.visit_neighbours(i, [&](const CellGrid::Neighbour& other) {
      const double range = ranges_.at(particles.size_class[i], particles.size_class[other.particle]);
      const Vector3 separation = reference_[other.particle] + box.displacement(other.image) - reference_[i];
      const double squared = dot(separation, separation);
      if (other.particle == i && squared < range * range) {
        throw std::invalid_argument("the box is so small that a particle interacts with its own image");
      }
      if (other.particle > i && squared < (range + skin_) * (range + skin_)) {
        near.push_back(other);
      }
    });
    std::sort(near.begin(), near.end());
    for (const CellGrid::Neighbour& other : near) {
      auto image = std::find(images_.begin(), images_.end(), other.image);
      if (image == images_.end()) {
        image = images_.insert(image, other.image);
      }
      const std::size_t kind =
          particles.size_class[i] * ranges_.classes() + particles.size_class[other.particle];
      pairs_.push_back({i, other.particle, static_cast<std::uint16_t>(image - images_.begin()),
                        static_cast<std::uint16_t>(kind)});
    }
  }
  collect_incidence(particles.count());
}

void NeighbourList::collect_incidence(std::size_t particles) {
  first_incident_.assign(particles + 1, 0);
  for (const Pair& pair : pairs_) {
    ++first_incident_[pair.first + 1];
    ++first_incident_[pair.second + 1];
  }
  for (std::size_t i = 0; i < particles; ++i) {
    first_incident_[i + 1] += first_incident_[i];
  }
  incident_.resize(2 * pairs_.size());
  std::vector<std::uint32_t> next(first_incident_.begin(), first_incident_.end() - 1);
  for (std::uint32_t p = 0; p < pairs_.size(); ++p) {
    incident_[next[pairs_[p].first]++] = 2 * p;
    incident_[next[pairs_[p].second]++] = 2 * p + 1;
  }
}

double NeighbourList::allowed_displacement(const ShearedBox& box) const {
  const double stretch = smallest_stretch(box.strain() - strain_at_build_);
  return 0.5 * (stretch * (ranges_.largest() + skin_) - ranges_.largest());
}

double NeighbourList::largest_displacement(const ParticleState& particles, const ShearedBox& box) const {
  const double strain = box.strain() - strain_at_build_;
  double largest = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double dx = particles.position.x[i] - reference_.x[i] - strain * reference_.y[i];
    const double dy = particles.position.y[i] - reference_.y[i];
    const double dz = particles.position.z[i] - reference_.z[i];
    largest = std::max(largest, dx * dx + dy * dy + dz * dz);
  }
  return std::sqrt(largest);
}

bool NeighbourList::holds(const ParticleState& particles, const ShearedBox& box) const {
  return largest_displacement(particles, box) < allowed_displacement(box);
}

}  // namespace peclet::engine
