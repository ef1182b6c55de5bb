#include <gtest/gtest.h>

#include "engine/snapshots/conversion.h"
#include "engine/snapshots/snapshot.h"
#include "tests/contract/refusal.h"

namespace peclet::engine {
namespace {

const std::string about =
    R"(Lattice="10 0 0 2.5 20 0 0 0 40" Properties=species:S:1:pos:R:3:radius:R:1:other:R:2:id:I:1 pbc="T T T" Time=1.5)";
const std::string spheres = "B 1 2 3 1.4 0 0 7\nA -1e1 0 0 1 0 0 2\n";
const std::string text = "2\n" + about + "\n" + spheres;

std::string refusal(const std::string& bytes) {
  return refusal_by([&] {
    for (const std::string_view frame : xyz_frames(bytes, "t.xyz")) read_xyz_frame(frame, "t.xyz");
  });
}

// Returns the bytes with `to` in the place of `from`, at most `times` times.
std::string replaced(std::string bytes, const std::string& from, const std::string& to, int times) {
  for (std::size_t at = bytes.find(from); at != std::string::npos && times-- > 0;
       at = bytes.find(from, at + to.size()))
    bytes.replace(at, from.size(), to);
  return bytes;
}

TEST(XyzSnapshot, IsSortedByIdsAndPassesOverWhatItDoesNotKnow) {
  const Snapshot snapshot = read_xyz_frame(text, "t.xyz");
  const Matrix3 lattice = {Vector3{10, 0, 0}, Vector3{2.5, 20, 0}, Vector3{0, 0, 40}};
  EXPECT_TRUE(snapshot.lattice == lattice);
  EXPECT_TRUE(snapshot.position[0] == (Vector3{-10, 0, 0}) && snapshot.position[1] == (Vector3{1, 2, 3}));
  EXPECT_EQ(snapshot.radius, (std::vector<double>{1, 1.4}));
  EXPECT_EQ(snapshot.species_names[snapshot.species[1]], "B");
  EXPECT_EQ(snapshot.time, 1.5);
  EXPECT_FALSE(snapshot.strain || snapshot.single);
}

TEST(XyzSnapshot, OfATextThatWasWrittenIsWhatWasWritten) {
  Snapshot snapshot = read_xyz_frame(text, "t.xyz");
  snapshot.corner = {-1, 0.1, 1.0 / 3};
  snapshot.step = 77;
  snapshot.strain = 2.0 / 3;
  snapshot.velocity = {{1e-300, -1, 2.0 / 3}, {0, 0, 1}};
  snapshot.spin = {{3, 2, 1}, {0.1, 0.2, 0.3}};
  snapshot.image = {{1, -2, 0}, {0, 0, 7}};
  snapshot.stress = {{1, 2, 3, 4, 5, 6}, {-1, -2, -3, -4, -5, -6.5}};
  snapshot.contact_number = {3, 0};
  snapshot.stress_of_cell["total"] = {1, 2, 3, 4, 5, 6};
  const std::string written = xyz_frame(snapshot);
  const Snapshot read = read_xyz_frame(written, "t.xyz");
  EXPECT_TRUE(read.position == snapshot.position && read.velocity == snapshot.velocity &&
              read.spin == snapshot.spin);
  EXPECT_TRUE(read.lattice == snapshot.lattice && read.corner == snapshot.corner);
  EXPECT_TRUE(read.image == snapshot.image && read.radius == snapshot.radius);
  EXPECT_EQ(read.contact_number, snapshot.contact_number);
  EXPECT_EQ(read.stress[1].yz, -6.5);
  EXPECT_EQ(read.step, 77U);
  EXPECT_EQ(read.strain, 2.0 / 3);
  EXPECT_TRUE(contains(written, "stress_total=\"1 2 3 4 5 6\""));
}

// One set of spheres as editors, shells and other programs save it.
TEST(XyzSnapshot, IsReadInEveryDialect) {
  const auto everywhere = [](const std::string& from, const std::string& to) {
    return replaced(text, from, to, 99);
  };
  for (const std::string& bytes :
       {everywhere("\n", "\r\n"), "\xef\xbb\xbf" + text, text + "\n \t\n\r\n", everywhere("\"", "'"),
        everywhere(" 1 ", "\t+1 "), everywhere("2\nL", " 2 \nL"),
        everywhere(" pbc", "  note=\"Lattice=1 Time=2\" flag pbc"), everywhere("species:S", "type:S")}) {
    EXPECT_EQ(refusal(bytes), "") << bytes;
    const std::vector<std::string_view> frames = xyz_frames(bytes, "t.xyz");
    ASSERT_EQ(frames.size(), 1U) << bytes;
    const Snapshot read = read_xyz_frame(frames[0], "t.xyz"), plain = read_xyz_frame(text, "t.xyz");
    EXPECT_TRUE(read.position == plain.position && read.radius == plain.radius) << bytes;
    EXPECT_TRUE(read.species == plain.species && read.species_names == plain.species_names) << bytes;
    EXPECT_EQ(read.time, 1.5) << bytes;
  }
}

// A key that chemistry programs take for element symbols gets another name.
TEST(XyzSnapshot, IsWrittenWithTypesThatAreWords) {
  Snapshot snapshot = read_xyz_frame(text, "t.xyz");
  snapshot.species_names = {"", "two words"};
  const std::string written = xyz_frame(snapshot);
  EXPECT_TRUE(contains(written, "Properties=id:I:1:type:S:1:pos:R:3"));
  EXPECT_EQ(written.find("species"), std::string::npos) << written;
  EXPECT_EQ(read_xyz_frame(written, "t.xyz").species_names, (std::vector<std::string>{"1", "2"}));
}

TEST(XyzSnapshot, HasAsManyFramesAsTheText) {
  const std::string both = text + text + "\n";
  EXPECT_EQ(xyz_frames(both, "t.xyz").size(), 2U);
  EXPECT_EQ(xyz_frames(text.substr(0, text.size() - 1), "t.xyz").size(), 1U);
  EXPECT_TRUE(xyz_frames("", "t.xyz").empty());
}

TEST(XyzSnapshot, ThatIsNoneIsRefused) {
  EXPECT_EQ(refusal(text), "");
  const auto replaced = [](const std::string& from, const std::string& to) {
    EXPECT_TRUE(contains(text, from));
    return engine::replaced(text, from, to, 1);
  };
  for (const auto& [bytes, reason] : std::vector<std::pair<std::string, std::string>>{
           {"3\n" + about + "\n" + spheres, "must have 4 lines after the first"},
           {"two\n", "begins with \"two\""},
           {"99999999999999999999\n", "begins with"},
           {"-1\n\n", "begins with"},
           {replaced("2.5 20 0", "20 0 0"), "must have three edges of different directions"},
           {replaced("2.5 20 0", "2.5 20"), "Lattice: \"\": must be a number"},
           {replaced("2.5 20 0", "2.5 20 0 0"), "Lattice: must be nine numbers"},
           {replaced("pbc=\"T T T\"", "pbc=\"T T T"), "pbc: must end its value with a quotation mark"},
           {replaced("pbc=\"T T T\"", "Time=2"), "Time: must be in the second line of a frame once"},
           {replaced("other:R:2", "id:I:1:x:R:1"), "Properties: id: must be there once"},
           {replaced("other:R:2", "id:I:2"), "Properties: id: must be there once"},
           {replaced("other:R:2", "type:S:1:x:R:1"), "Properties: type: must be there once"},
           {replaced("Lattice", "lattice"), "must be in the second line"},
           {replaced("radius:R:1", "radii:R:1"), "must have pos:R:3 and radius:R:1"},
           {replaced("other:R:2", "other:R:x"), "Properties: \"x\""},
           {replaced("other:R:2", "other:R:9999999"), "Properties"},
           {replaced("1.4 0 0 7", "1.4 0 0"), "sphere 1: \"\": must be a number"},
           {replaced("1.4 0 0 7", "1.4 0 0 7 8"), "sphere 1: must have the columns"},
           {replaced("1.4 0 0 7", "nan 0 0 7"), "must be a number"},
           {replaced("1.4 0 0 7", "-1.4 0 0 7"), "radius -1.4 of sphere 1: must be > 0"},
           {replaced("0 0 7", "0 0 2"), "id 2: must be there once"}}) {
    EXPECT_TRUE(contains(refusal(bytes), reason));
  }
}

}  // namespace
}  // namespace peclet::engine
