// The spheres of one moment, as a file has them.
//
// What a file lacks is empty here. Spheres are in the order of the file's ids; lengths and forces are in the
// units of the scene. `single` files (GSD) hold numbers of 32 bits, of which each is a double here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/snapshots/gsd_file.h"
#include "engine/state/matrix3.h"
#include "engine/state/periodic_cell.h"
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

// Throws InputError naming `file` if a number of the snapshot cannot be computed with as what it is:
//   lattice vectors: linearly independent, of lengths from 1e-30 to 1e30, none shorter across the others than
//     a millionth of the longest one;
//   centres and corner: within a million cells of the origin, so that a cell can be counted in an integer;
//   radii: from a millionth of the longest edge to that edge;
//   other numbers: finite, at most 1e30 in magnitude; a time, unless it is 0, at least 1e-30;
//   names of stresses: letters, digits, '_', '-' and '/';
//   contacts: between two spheres that are there, pushing apart or not at all.
// Requires lists of as many entries as there are spheres, or none.
void check_snapshot(const Snapshot& snapshot, const std::string& file);

// Reads a frame of a GSD file of the schema "hoomd", of this program or another one. As the schema has it,
// what a frame lacks is that of the first frame, if this has as many spheres, and else the schema's default:
// diameter 1, and no motion. Throws InputError for what is not of the schema, and for what check_snapshot()
// refuses.
Snapshot read_gsd_frame(const gsd::Reader& file, std::uint64_t frame);

// Frames of extended XYZ: what this program leaves (final.xyz, `peclet-engine trajectory`), and what others
// write in the same columns.
//
// The texts of the frames: a line with the number of spheres, one with Lattice and Properties, and one for
// each sphere. `file` names the text in messages. Throws InputError where a frame is not whole.
std::vector<std::string_view> xyz_frames(std::string_view text, const std::string& file);

// Reads one of these frames. Asks for a Lattice, pos:R:3 and radius:R:1; takes id:I:1, by which spheres are
// sorted, type:S:1 or species:S:1, velo:R:3, angular_velocity:R:3, image:I:3, stress:R:6 and contacts:I:1,
// and of the second line Origin, Step, Time, Strain and Velocity_gradient. Other columns and keys are passed
// over. Throws InputError, also for what check_snapshot() refuses.
Snapshot read_xyz_frame(std::string_view frame, const std::string& file);

// A file of frames: a GSD file, or extended XYZ of up to 256 MiB: what it is shows in its first bytes, not in
// its name.
class SnapshotFile {
 public:
  // Throws InputError.
  explicit SnapshotFile(const std::filesystem::path& path);

  std::uint64_t frames() const;
  // Counted from 0, or from the last one, -1. Throws InputError where there is no such frame.
  std::uint64_t index_of(std::int64_t frame) const;
  // Throws InputError.
  Snapshot read(std::uint64_t frame) const;

 private:
  struct Text {
    std::string text;
    std::vector<std::string_view> frames;  // of the text
  };

  std::filesystem::path path_;
  std::optional<gsd::Reader> gsd_;
  std::unique_ptr<Text> text_;
};

// What a person should know of a file without sizes.
std::string note_on_sizes(const std::string& file);

// "first:last:step", of which each may be left out, or one number: the frames, at most `count`, that it
// names. Both ends are included, and count from the last frame where they are negative. Throws InputError for
// what is no such text (in `option`) and for frames that are not there.
std::vector<std::uint64_t> chosen_frames(const std::string& range, const SnapshotFile& file,
                                         const std::string& option);

}  // namespace peclet::engine
