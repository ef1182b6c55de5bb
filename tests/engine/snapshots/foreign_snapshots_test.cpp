// Texts of LAMMPS and LF_DEM. Expected numbers follow from the manuals of the formats, by hand.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "engine/snapshots/conversion.h"
#include "engine/snapshots/snapshot.h"
#include "tests/contract/refusal.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// Two frames; the second has a tilted cell, whose bounds surround it: xlo = 1 + min(0, -2) ...
const std::string dump =
    "ITEM: UNITS\nlj\nITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n"
    "-5 5\n0 20\n0 30\nITEM: ATOMS id type xs ys zs diameter extra\n9 2 0.5 0.5 0.1 2.8 x\n4 1 0 0.25 1 2 y\n"
    "ITEM: TIME\n1.5\nITEM: TIMESTEP\n8\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
    "-1 11 -2\n0 20 0\n0 30 0\n"
    "ITEM: ATOMS xu yu zu radius vx vy vz omegax omegay omegaz ix iy iz\n1 2 3 1 4 5 6 7 8 9 0 -1 2\n";

const std::string data =
    "LAMMPS data file\n\n2 atoms\n2 atom types\n\n0 10 xlo xhi\n0 20 ylo yhi\n-1 29 zlo zhi\n2.5 0 0 xy xz "
    "yz\n\n"
    "Pair Coeffs # granular\n\n1 hooke 1 2\n\nAtoms # sphere\n\n2 1 2 1 1 2 3 0 0 1\n1 2 2.8 1 4 5 6 0 0 0 # "
    "one\n\n"
    "Velocities\n\n1 1 2 3 4 5 6\n2 -1 -2 -3 -4 -5 -6\n";

const std::string lf_dem =
    "# np1 np2 vf lx ly lz vf1 vf2 disp\n# 1 1 0.01 10 20 30 0.01 0 2.5\n1 2 3 1 \n4 5 6 1.4 \n";

std::string refusal_of_dump(const std::string& bytes) {
  return refusal_by([&] {
    for (const std::string_view frame : lammps_dump_frames(bytes, "t")) read_lammps_dump_frame(frame, "t");
  });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(LammpsDump, HasItsSpheresByIdAndItsTiltedCell) {
  const auto frames = lammps_dump_frames(dump, "t");
  ASSERT_EQ(frames.size(), 2U);
  const Snapshot first = read_lammps_dump_frame(frames[0], "t"),
                 second = read_lammps_dump_frame(frames[1], "t");
  EXPECT_EQ(first.step, 7U);
  EXPECT_TRUE(first.position[0] == (Vector3{-5, 5, 30}) && first.position[1] == (Vector3{0, 10, 3}));
  EXPECT_EQ(first.radius, (std::vector<double>{1, 1.4}));
  EXPECT_EQ(first.species_names[first.species[0]], "1");
  EXPECT_TRUE(first.velocity.empty());
  const Matrix3 tilted = {Vector3{10, 0, 0}, Vector3{-2, 20, 0}, Vector3{0, 0, 30}};
  EXPECT_TRUE(second.lattice == tilted && second.corner == (Vector3{1, 0, 0}));
  EXPECT_EQ(second.time, 1.5);
  EXPECT_TRUE(second.velocity[0] == (Vector3{4, 5, 6}) && second.spin[0] == (Vector3{7, 8, 9}));
  EXPECT_TRUE(second.image.empty()) << "unwrapped positions have the images in them";
}

// The vectors of the cell are (10, 0, 0), (-3, 20, 0), (2, -1, 30); bounds are those of its corners.
TEST(LammpsDump, HasScaledPositionsAndNegativeTilts) {
  const Snapshot read = read_lammps_dump_frame(
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
      "-3 12 -3\n-1 20 2\n0 30 -1\nITEM: ATOMS xs ys zs radius ix iy iz\n0.5 0.5 0.5 1 0 -1 2\n",
      "t");
  const Matrix3 cell = {Vector3{10, 0, 0}, Vector3{-3, 20, 0}, Vector3{2, -1, 30}};
  EXPECT_TRUE(read.lattice == cell && read.corner == (Vector3{0, 0, 0}));
  EXPECT_TRUE(read.position[0] == (Vector3{4.5, 9.5, 15}));
  EXPECT_EQ(read.image[0].y, -1);
}

TEST(LammpsDump, HasTheSameSpeciesInAnyOrderOfItsAtoms) {
  const std::string head =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
      "ITEM: ATOMS id type x y z radius\n";
  const Snapshot one = read_lammps_dump_frame(head + "1 10 1 1 1 1\n2 2 5 5 5 1\n", "t");
  const Snapshot other = read_lammps_dump_frame(head + "2 2 5 5 5 1\n1 10 1 1 1 1\n", "t");
  EXPECT_EQ(one.species_names, (std::vector<std::string>{"2", "10"}));
  EXPECT_EQ(other.species_names, one.species_names);
  EXPECT_EQ(one.species, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(other.species, one.species);
}

TEST(LammpsDump, OfThisProgramIsReadBack) {
  Snapshot snapshot = read_lf_dem(lf_dem, "t");
  snapshot.corner = {-1, 0.1, 1.0 / 3};
  snapshot.stress = {{1, 2, 3, 4, 5, 6}, {-1, -2, -3, -4, -5, -6.5}};
  snapshot.contact_number = {3, 0};
  const Snapshot read = read_lammps_dump_frame(lammps_frame(snapshot), "t");
  EXPECT_TRUE(read.position == snapshot.position && read.radius == snapshot.radius);
  EXPECT_NEAR(norm(read.lattice.column[1] - snapshot.lattice.column[1]), 0, 1e-14);
  EXPECT_NEAR(norm(read.corner - snapshot.corner), 0, 1e-14);
  EXPECT_EQ(read.contact_number, snapshot.contact_number);
  EXPECT_EQ(read.stress[1].yz, -6.5);
}

TEST(LammpsDump, ThatCannotBeReadIsRefusedWithItsFault) {
  for (const auto& [from, to, reason] : std::initializer_list<std::array<const char*, 3>>{
           {"pp pp pp", "pp pp ff", "ITEM: BOX BOUNDS pp pp ff: must be followed by pp pp pp"},
           {"pp pp pp", "", "ITEM: BOX BOUNDS : must be followed"},
           {"-5 5", "5 -5", "BOX BOUNDS: must be there, with the lower end of each edge first"},
           {"xy xz yz pp", "abc origin pp", "ITEM: BOX BOUNDS abc origin"},
           {" diameter", " mass", "must have x y z (or xu, xs, xsu ...) and radius or diameter"},
           {" zs ", " z ", "must have x y z"},
           {"0.5 0.5 0.1 2.8 x", "0.5 0.5 0.1 2.8", "sphere 1: must have the columns"},
           {"0.25 1 2 y", "0.25 1 two y", "sphere 2: \"two\": must be a number"},
           {"4 1 0 0.25", "9 1 0 0.25", "id 9: must be there once"},
           {"ATOMS\n2", "ATOMS\n-2", "frame 0: must have ITEM: NUMBER OF ATOMS, 1 to"},
           {"ATOMS\n1", "ATOMS\n3", "frame 1: must have 3 atoms; 2 are missing"},
           {"ITEM: UNITS", "ITEM: UNICORNS", "ITEM: UNICORNS: must be an ITEM of a dump that is known"},
           {"xu yu zu", "xu xu zu", "xu: must be there once"},
       }) {
    const std::string refusal = refusal_of_dump(replaced(dump, from, to));
    EXPECT_TRUE(contains(refusal, reason)) << refusal;
  }
}

TEST(LammpsData, HasItsSpheresByIdAndTheirMotion) {
  EXPECT_TRUE(begins_as_lammps_data(data));
  EXPECT_FALSE(begins_as_lammps_data(dump) || begins_as_lammps_data(lf_dem));
  const Snapshot read = read_lammps_data(data, "t");
  EXPECT_TRUE(read.position[0] == (Vector3{4, 5, 6}) && read.position[1] == (Vector3{1, 2, 3}));
  EXPECT_EQ(read.radius, (std::vector<double>{1.4, 1}));
  const Matrix3 tilted = {Vector3{10, 0, 0}, Vector3{2.5, 20, 0}, Vector3{0, 0, 30}};
  EXPECT_TRUE(read.lattice == tilted && read.corner == (Vector3{0, 0, -1}));
  EXPECT_TRUE(read.velocity[1] == (Vector3{-1, -2, -3}) && read.spin[0] == (Vector3{4, 5, 6}));
  EXPECT_EQ(read.image[1].z, 1);
}

TEST(LammpsData, ThatCannotBeReadIsRefusedWithItsFault) {
  for (const auto& [from, to, reason] : std::initializer_list<std::array<const char*, 3>>{
           {"Atoms # sphere", "Atoms # atomic", "must be \"Atoms # sphere\""},
           {"Atoms # sphere", "Atoms", "must be \"Atoms # sphere\""},
           {"Atoms # sphere\n", "Atoms # sphere\n1", "Atoms: must be followed by an empty line"},
           {"2 1 2 1 1 2 3 0 0 1", "2 1 2 1 1 2",
            "Atoms, line 1: must be id, type, diameter, density, x, y, z"},
           {"2 1 2 1 1 2 3 0 0 1", "2 1 2 1 1 2 3", "Atoms: must have image flags in all lines, or in none"},
           {"2 -1 -2 -3 -4 -5 -6", "3 -1 -2 -3 -4 -5 -6", "Velocities: id 2: must be there"},
           {"1 1 2 3 4 5 6", "1 1 2 3", "Velocities, line 1: must be id, velocity and angular velocity"},
           {"0 10 xlo", "a 10 xlo", "header: \"a\": must be a number"},
           {"0 10 xlo xhi\n", "", "xlo xhi, ylo yhi and zlo zhi: must be there, with the lower end"},
           {"2.5 0 0 xy", "2.5 0 xy", "must be numbers before xy"},
           {"2.5 0 0 xy xz yz", "1 0 0 avec", "1 0 0 avec: must not be there: general triclinic cells"},
           {"2 atoms", "1 atoms", "Atoms: must have 1 lines, one for each of the atoms"},
           {"Velocities\n\n1 1", "Atoms # sphere\n\n1 1", "Atoms: must be there once"},
           {"2 atoms", "3 atoms", "Atoms, line 3: must be id"},
       }) {
    const std::string text = replaced(data, from, to);
    const std::string refusal = refusal_by([&] { read_lammps_data(text, "t"); });
    EXPECT_TRUE(contains(refusal, reason)) << refusal;
  }
  EXPECT_EQ(refusal_by([] { read_lammps_data("title\n2 atoms\n", "t"); }),
            "t: Atoms: must be a section of the file");
}

TEST(LfDem, HasTheGradientAlongY) {
  const Snapshot read = read_lf_dem(lf_dem, "t");
  const Matrix3 exchanged = {Vector3{10, 0, 0}, Vector3{2.5, 30, 0}, Vector3{0, 0, 20}};
  EXPECT_TRUE(read.lattice == exchanged);
  EXPECT_TRUE(read.position[0] == (Vector3{1, 3, 2}) && read.position[1] == (Vector3{4, 6, 5}));
  EXPECT_EQ(read.radius, (std::vector<double>{1, 1.4}));
}

TEST(LfDem, OfNoSpheresIsRefused) {
  EXPECT_TRUE(contains(refusal_by([] { read_lf_dem("# np1 np2 lx ly lz\n# 0 0 9 9 9\n", "t"); }),
                       "0 spheres: must be 1 to"));
}

// Titles of data files are free; other programs begin them with #.
TEST(SnapshotFile, IsKnownByItsBeginning) {
  const TemporaryFolder folder;
  const auto count = [&](const std::string& text) {
    write_durably(folder / "t", text);
    return SnapshotFile(folder / "t").read(0).count();
  };
  EXPECT_EQ(count(data), 2U);
  EXPECT_EQ(count("# " + data), 2U);
  EXPECT_EQ(count(dump), 2U);
  EXPECT_EQ(count(replaced(dump, "ITEM: TIME\n", "\nITEM: TIME\n")), 2U);
  EXPECT_EQ(count(lf_dem), 2U);
  EXPECT_EQ(count("1\n1 atoms Lattice=\"9 0 0 0 9 0 0 0 9\" Properties=pos:R:3:radius:R:1\n1 2 3 1\n"), 1U);
}

TEST(LfDem, ThatCannotBeReadIsRefusedWithItsFault) {
  for (const auto& [from, to, reason] : std::initializer_list<std::array<const char*, 3>>{
           {"lx ly", "lx lq", "ly: must be a name in the first line"},
           {"vf1 vf2 disp", "vf1 z_bot disp", "z_bot: must not be there: walls are not available"},
           {"10 20 30", "10 0 30", "ly 0: must be > 0: monolayers are not available"},
           {"# 1 1", "# 1 2", "2 spheres: must be np1 + np2 = 3"},
           {"# 1 1", "1 1", "the first two lines: must be # with names"},
           {"4 5 6 1.4", "4 5 6", "sphere 2: \"\": must be a number"},
           {"4 5 6 1.4", "4 5 6 1.4 7", "sphere 2: must be x, y, z and radius, and no more"},
           {"vf1 vf2", "lx vf2", "lx: must be there once"},
           {"0 2.5", "0 2.5 6", "the second line: must have a value for each name"},
       }) {
    const std::string text = replaced(lf_dem, from, to);
    const std::string refusal = refusal_by([&] { read_lf_dem(text, "t"); });
    EXPECT_TRUE(contains(refusal, reason)) << refusal;
  }
}

}  // namespace
}  // namespace peclet::engine
