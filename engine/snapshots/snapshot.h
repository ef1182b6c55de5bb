// Reads snapshots: the spheres of one moment, as a file has them.
//
// Lists that a file lacks are empty. Spheres are in the order of the file's ids; lengths and forces are in
// the units of the scene. `single` files (GSD) hold numbers of 32 bits, each of which is a double here.
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

// The limits of spheres and species in a file.
constexpr std::uint32_t most_spheres = 10'000'000, most_types = 4096;

// Two spheres that touch, by their indices in the lists of the snapshot.
struct SnapshotContact {
  std::uint32_t first, second;
  double normal_force, tangential_force;
};

struct Snapshot {
  std::size_t count() const { return position.size(); }

  // The lattice vectors as columns, and the corner of the cell where they begin. In simple shear they are
  // (lx, 0, 0), (xy, ly, 0), (xz, yz, lz); in extension the cell is turned.
  Matrix3 lattice;
  Vector3 corner;
  std::uint64_t step = 0;
  std::optional<double> time, strain;
  std::optional<Matrix3> velocity_gradient;  // gradient of the uniform part of the flow
  bool single = false;
  bool has_sizes = true;  // false if the radii are the default of a file without diameters

  std::vector<Vector3> position;
  std::vector<double> radius;
  std::vector<std::uint32_t> species;
  std::vector<std::string> species_names;
  std::vector<Vector3> velocity, spin;  // in the laboratory; spin is the angular velocity
  std::vector<LatticeShift> image;      // the unwrapped position is position + image . lattice
  std::vector<SymmetricTensor> stress;  // V sigma_i
  std::vector<std::uint32_t> contact_number;
  std::optional<std::vector<SnapshotContact>> contacts;
  std::map<std::string, SymmetricTensor> stress_of_cell;  // "total", "solvent" ...
};

// True unless the cell is that of simple shear, with the first edge along x and the second in the xy plane.
inline bool is_turned(const Snapshot& snapshot) {
  const auto& [a, b, c] = snapshot.lattice.column;
  return a.y != 0 || a.z != 0 || b.z != 0 || !(a.x > 0 && b.y > 0 && c.z > 0);
}

// Puts the spheres in another order: those of the indices `order` in the lists as they are, one after the
// other. Contacts, which name spheres by their old places, are left out.
void arrange(Snapshot& snapshot, const std::vector<std::size_t>& order);

// Throws InputError, naming `file`, unless the snapshot can be computed with:
//   lattice vectors: linearly independent, from 1e-30 to 1e30 long, none of them shorter across those before
//     it than a millionth of the longest one;
//   centres and corner: within a million cells of the origin, so that cells are counted in integers;
//   radii: from a millionth of the longest edge to that edge;
//   other numbers: at most 1e30 in magnitude; a time 0 or at least 1e-30 in magnitude;
//   names of stresses: letters, digits, '_', '-' and '/';
//   contacts: between two different spheres, with a normal force >= 0.
// Requires lists that are empty or have an entry for each sphere.
void check_snapshot(const Snapshot& snapshot, const std::string& file);

// Reads a frame of a GSD file of the schema "hoomd", written by any program. Data that a frame lacks are, by
// the schema, those of the first frame if it has the same number of spheres, or else the defaults: diameter 1
// and no motion. Throws InputError if the frame is not of the schema or check_snapshot() refuses it.
Snapshot read_gsd_frame(const gsd::Reader& file, std::uint64_t frame);

// Returns the texts of the frames of extended XYZ: a line with the number of spheres, one with Lattice and
// Properties, and one for each sphere. `file` names the text in messages. Throws InputError if one is cut.
std::vector<std::string_view> xyz_frames(std::string_view text, const std::string& file);

// Reads one of these frames, written by this program (final.xyz, `peclet-engine trajectory`) or another one.
// Requires Lattice, pos:R:3 and radius:R:1. Also reads id:I:1, by which spheres are sorted, type:S:1 or
// species:S:1, velo:R:3, angular_velocity:R:3, image:I:3, stress:R:6 and contacts:I:1, and from the second
// line Origin, Step, Time, Strain and Velocity_gradient. Ignores other columns and keys. Throws InputError if
// the frame is faulty or check_snapshot() refuses it.
Snapshot read_xyz_frame(std::string_view frame, const std::string& file);

// Returns the texts of the frames of a dump of LAMMPS, and reads one of them: a periodic box with or without
// tilt; x y z, xu yu zu, xs ys zs or xsu ysu zsu; radius or diameter; and, where they are, id, by which
// spheres are sorted, type, ix iy iz (not beside xu or xsu), vx vy vz, omegax omegay omegaz, and what
// lammps_frame() writes. Ignores other columns. Throw InputError as those of extended XYZ.
std::vector<std::string_view> lammps_dump_frames(std::string_view text, const std::string& file);
Snapshot read_lammps_dump_frame(std::string_view frame, const std::string& file);

// Returns true if one of the first lines of a text, but not the very first, is "N atoms", as in a data file
// of LAMMPS.
bool begins_as_lammps_data(std::string_view text);
// Reads a data file of LAMMPS with "Atoms # sphere", and its velocities. Throws InputError as above.
Snapshot read_lammps_data(std::string_view text, const std::string& file);

// Reads a configuration of LF_DEM: two lines with # and the names and values of lx, ly, lz, disp ..., then x,
// y, z and radius of each sphere. LF_DEM has the gradient of shear along z; y and z are exchanged, so that it
// is along y. Throws InputError as above, and for walls.
Snapshot read_lf_dem(std::string_view text, const std::string& file);

// A file of frames: GSD, or a text of up to 256 MiB. Its beginning, not its name, tells which.
class SnapshotFile {
 public:
  // Throws InputError if the file cannot be read or has no frame.
  explicit SnapshotFile(const std::filesystem::path& path);

  std::uint64_t frames() const;
  // Returns the index of a frame counted from 0, or back from -1, the last. Throws InputError if beyond them.
  std::uint64_t index_of(std::int64_t frame) const;
  // Throws InputError if the frame is faulty.
  Snapshot read(std::uint64_t frame) const;

 private:
  struct Text {
    explicit Text(const std::filesystem::path& path);
    std::string text;
    std::vector<std::string_view> frames;  // parts of the text
    Snapshot (*read)(std::string_view frame, const std::string& file);
  };

  std::filesystem::path path_;
  std::optional<gsd::Reader> gsd_;
  std::unique_ptr<Text> text_;
};

// Returns the note for users of a file without diameters.
std::string note_on_sizes(const std::string& file);

// Returns the frames that `range` names: "first:last:step", each of which may be left out, or one number.
// Both ends are included; negative numbers count from the last frame. Throws InputError if the text, given in
// `option`, is faulty or a frame does not exist.
std::vector<std::uint64_t> chosen_frames(const std::string& range, const SnapshotFile& file,
                                         const std::string& option);

}  // namespace peclet::engine
