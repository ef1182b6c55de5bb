// The spheres of one moment, as a file has them.
//
// What a file lacks is empty here. Spheres are in the order of the file's ids; lengths and forces are in the
// units of the scene. `single` files (GSD) hold numbers of 32 bits, of which each is a double here.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/state/basis_change.h"
#include "engine/state/matrix3.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// A file that says more is not believed.
constexpr std::uint32_t most_spheres = 10'000'000, most_types = 4096;

// Two spheres that touch, by their places in the lists of the snapshot.
struct SnapshotContact {
  std::uint32_t first, second;
  double normal_force, tangential_force;
};

struct Snapshot {
  std::size_t count() const { return position.size(); }

  // Lattice vectors as columns, and the corner of the cell from which they lead. Simple shear keeps them
  // (lx, 0, 0), (xy, ly, 0), (xz, yz, lz); in extension the cell is turned.
  Matrix3 lattice;
  Vector3 corner;
  std::uint64_t step = 0;
  std::optional<double> time, strain;
  std::optional<Matrix3> velocity_gradient;  // of the uniform part of the flow
  bool single = false;
  bool has_sizes = true;  // false: the radii are the default of a file without any

  std::vector<Vector3> position;
  std::vector<double> radius;
  std::vector<std::uint32_t> species;
  std::vector<std::string> species_names;
  std::vector<Vector3> velocity, spin;  // in the laboratory; spin is the angular velocity
  std::vector<LatticeShift> image;      // position + image . lattice is the way that a sphere has gone
  std::vector<SymmetricTensor> stress;  // V sigma_i
  std::vector<std::uint32_t> contact_number;
  std::optional<std::vector<SnapshotContact>> contacts;
  std::map<std::string, SymmetricTensor> stress_of_cell;  // "total", "solvent" ...
};

// Whether the cell is not the one of simple shear, whose first edge is along x and the second in the plane of
// x and y.
inline bool is_turned(const Snapshot& snapshot) {
  const auto& [a, b, c] = snapshot.lattice.column;
  return a.y != 0 || a.z != 0 || b.z != 0 || !(a.x > 0 && b.y > 0 && c.z > 0);
}

}  // namespace peclet::engine
