// Fuzz target for files of spheres, GSD and texts: read, written as text, read again and drawn.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <span>
#include <stdexcept>

#include "contract/errors.h"
#include "engine/pictures/colouring.h"
#include "engine/pictures/picture.h"
#include "engine/snapshots/conversion.h"
#include "engine/snapshots/gsd_file.h"
#include "engine/snapshots/snapshot.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace peclet;
using namespace peclet::engine;

// A file in memory with a path by which it is opened again.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes) : number_(::memfd_create("spheres", MFD_CLOEXEC)) {
    if (number_ < 0 || ::write(number_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      std::abort();
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(number_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_;
};

void require(bool holds, const char* claim) {
  if (!holds) throw std::logic_error(claim);
}

// Checks that a frame written as text reads back equal.
void check_text(const Snapshot& snapshot) {
  const std::string text = xyz_frame(snapshot);
  const std::vector<std::string_view> frames = xyz_frames(text, "again");
  require(frames.size() == 1, "one frame is written as one");
  Snapshot again = read_xyz_frame(frames[0], "again");
  require(again.count() == snapshot.count(), "a text has as many spheres");
  require(again.lattice == snapshot.lattice && again.corner == snapshot.corner, "a text has the cell");
  require(snapshot.single || (again.position == snapshot.position && again.radius == snapshot.radius &&
                              again.velocity == snapshot.velocity),
          "a text has every bit of doubles");
  require(again.image == snapshot.image && again.contact_number == snapshot.contact_number,
          "a text has whole numbers");
  again.single = snapshot.single;
  again.species_names = snapshot.species_names;
  if (!is_turned(snapshot)) lammps_frame(snapshot);
}

void draw(const Snapshot& snapshot) {
  PictureOptions options;
  options.size = "64x64";
  for (const std::string& colour : names_of_colourings()) {
    options.colour = colour;
    try {
      picture_of(snapshot, options);
    } catch (const InputError&) {  // the frame lacks these quantities
    }
  }
  if (!snapshot.contacts) return;
  options.colour = "species";
  options.chains = true;
  picture_of(snapshot, options);
}

template <class Value>
std::vector<Value> repeated(const std::vector<Value>& values, std::size_t times) {
  std::vector<Value> all;
  for (std::size_t k = 0; k < times; ++k) all.insert(all.end(), values.begin(), values.end());
  return all;
}

std::string trajectory() {
  gsd::Frames frames;
  for (std::uint64_t frame = 0; frame < 2; ++frame) {
    frames.add_single<std::uint64_t>("configuration/step", 10 * frame);
    frames.add("configuration/box", std::vector<float>{6, 6, 6, 0.25F, 0, 0});
    frames.add_single<std::uint32_t>("particles/N", 3);
    frames.add("particles/position", std::vector<float>{-2, 0, 0, 0, 0, 0, 2.3F, 0.5F, 1}, 3);
    if (frame == 0) {
      frames.add("particles/types", std::vector<std::int8_t>{'A', 0, 'B', 0}, 2);
      frames.add("particles/typeid", std::vector<std::uint32_t>{0, 0, 1});
      frames.add("particles/diameter", std::vector<float>{2, 2, 2.8F});
    }
    frames.add("particles/image", std::vector<std::int32_t>(9, 1), 3);
    frames.add("particles/velocity", repeated<float>({1, 2, 3}, 3), 3);
    frames.add("log/particles/angular_velocity", repeated<float>({1, 0, -1}, 3), 3);
    frames.add_single("log/time", 0.5);
    frames.add_single("log/strain", 1.0);
    frames.add("log/particles/stress", repeated<float>({1, 2, 3, 4, 5, 6}, 3), 6);
    frames.add("log/stress/total", std::vector<double>{1, 2, 3, 4, 5, 6});
    frames.add("log/particles/contact_number", std::vector<std::uint32_t>{1, 2, 1});
    frames.add("bonds/group", std::vector<std::uint32_t>{0, 1, 1, 2}, 2);
    frames.add("log/bonds/normal_force", std::vector<float>{3, 1});
    frames.add("log/bonds/tangential_force", std::vector<float>{0.5F, 0});
    frames.end_frame();
  }
  return frames.head() + frames.pending() + frames.tail();
}

}  // namespace

std::size_t inputs_accepted = 0;

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile memory({data, size});
  try {
    const SnapshotFile file(memory.path());
    for (std::uint64_t frame = 0; frame < std::min<std::uint64_t>(file.frames(), 3); ++frame) {
      const Snapshot snapshot = file.read(frame);
      check_text(snapshot);
      if (snapshot.count() <= 20) draw(snapshot);
    }
    ++inputs_accepted;
  } catch (const InputError&) {  // refused with a message
  }
  return 0;
}

std::vector<std::string> valid_inputs() {
  return {
      trajectory(),
      "3\nLattice=\"6 0 0 1.5 6 0 0 0 6\" Origin=\"-3 -3 -3\" "
      "Properties=id:I:1:type:S:1:pos:R:3:radius:R:1:velo:R:3:angular_velocity:R:3:image:I:3:stress:R:6:"
      "contacts:I:1 pbc=\"T T T\" Step=7 Time=0.5 Strain=1 stress_total=\"1 2 3 4 5 6\"\n"
      "0 A -2 0 0 1 1 2 3 1 0 -1 0 1 0 1 2 3 4 5 6 1\n1 A 0 0 0 1 1 2 3 1 0 -1 0 1 0 1 2 3 4 5 6 2\n"
      "2 B 2.3 0.5 1 1.4 1 2 3 1 0 -1 0 1 0 1 2 3 4 5 6 1\n",
      "1\r\nLattice='-7 -5.6 0 4.4 -9 0 0 0 9.4' Properties=pos:R:3:radius:R:1 "
      "Velocity_gradient='1 0 0 0 -1 0 0 0 0'\r\n1 +2 3 1\r\n\r\n",
      "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp pp\n-1 11 -2\n0 20 0\n0 "
      "30 0\n"
      "ITEM: ATOMS id type xs ys zs diameter vx vy vz omegax omegay omegaz ix iy iz\n"
      "2 1 0.5 0.5 0.1 2.8 1 2 3 4 5 6 0 -1 0\n1 2 0.2 0.7 0.9 2 1 2 3 4 5 6 0 0 0\n",
      "LAMMPS data file\n\n2 atoms\n\n0 10 xlo xhi\n0 20 ylo yhi\n-1 29 zlo zhi\n2.5 0 0 xy xz yz\n\nAtoms # "
      "sphere\n\n2 1 2 1 1 2 3 0 0 1\n1 2 2.8 1 4 5 6 0 0 0\n\nVelocities\n\n1 1 2 3 4 5 6\n2 -1 -2 -3 -4 -5 "
      "-6\n",
      "# np1 np2 vf lx ly lz vf1 vf2 disp\n# 1 1 0.01 10 20 30 0.01 0 2.5\n1 2 3 1 \n4 5 6 1.4 \n"};
}
