#include "engine/snapshots/conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "contract/errors.h"
#include "contract/named_files.h"

namespace peclet::engine {
namespace {

// Appends numbers to a text, each as the shortest one that is read back as the same float or double.
class RowText {
 public:
  RowText(std::string& text, bool single) : text_(text), single_(single) {}

  void add(double x) {
    const auto out = std::back_inserter(text_);
    single_ ? fmt::format_to(out, " {}", static_cast<float>(x)) : fmt::format_to(out, " {}", x);
  }
  void add(const Vector3& v) {
    for (const double x : {v.x, v.y, v.z}) add(x);
  }
  void add(const LatticeShift& k) { fmt::format_to(std::back_inserter(text_), " {} {} {}", k.x, k.y, k.z); }
  void add(const SymmetricTensor& t) {
    for (const double x : {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}) add(x);
  }
  void add(std::uint32_t n) { fmt::format_to(std::back_inserter(text_), " {}", n); }

  // Adds the entry of sphere i, if the frame has the list.
  template <class Value>
  void add(const std::vector<Value>& list, std::size_t i) {
    if (!list.empty()) add(list[i]);
  }

 private:
  std::string& text_;
  bool single_;
};

// Returns names of species that are words of a line: numbers replace names that are empty or have blanks.
std::vector<std::string> words_of_species(const Snapshot& snapshot) {
  const auto is_plain = [](char c) { return c > ' ' && c <= '~'; };
  std::vector<std::string> words = snapshot.species_names;
  for (std::size_t s = 0; s < words.size(); ++s) {
    if (words[s].empty() || !std::ranges::all_of(words[s], is_plain)) words[s] = std::to_string(s + 1);
  }
  return words;
}

using FrameText = std::string (*)(const Snapshot&);

FrameText text_of(const ConversionOptions& options) {
  if (options.format == "lammps") return lammps_frame;
  if (options.format == "xyz") return xyz_frame;
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending == ".lammpstrj" || ending == ".dump") return lammps_frame;
  if (ending == ".xyz" || ending == ".extxyz") return xyz_frame;
  throw InputError(options.output.empty() ? "--format" : "--output", "",
                   options.output.empty() ? "missing" : options.output,
                   "must end in .lammpstrj, .dump, .xyz or .extxyz, or --format must be lammps or xyz");
}

}  // namespace

std::string spaced(const Vector3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string lammps_frame(const Snapshot& snapshot) {
  const auto& [a, b, c] = snapshot.lattice.column;
  const double xy = b.x, xz = c.x, yz = c.y;
  const Vector3 low = snapshot.corner, high = low + Vector3{a.x, b.y, c.z};
  std::string text = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS xy xz yz pp pp pp\n{} {} {}\n{} {} "
      "{}\n{} {} "
      "{}\nITEM: ATOMS id type x y z ix iy iz radius{}{}{}{}\n",
      snapshot.step, snapshot.count(), low.x + std::min({0.0, xy, xz, xy + xz}),
      high.x + std::max({0.0, xy, xz, xy + xz}), xy, low.y + std::min(0.0, yz), high.y + std::max(0.0, yz),
      xz, low.z, high.z, yz, snapshot.velocity.empty() ? "" : " vx vy vz",
      snapshot.spin.empty() ? "" : " omegax omegay omegaz",
      snapshot.stress.empty() ? "" : " stress_xx stress_yy stress_zz stress_xy stress_xz stress_yz",
      snapshot.contact_number.empty() ? "" : " contacts");
  RowText row(text, snapshot.single);
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    fmt::format_to(std::back_inserter(text), "{} {}", i + 1, snapshot.species[i] + 1);
    row.add(snapshot.position[i]);
    row.add(snapshot.image.empty() ? LatticeShift{} : snapshot.image[i]);
    row.add(snapshot.radius[i]);
    row.add(snapshot.velocity, i);
    row.add(snapshot.spin, i);
    row.add(snapshot.stress, i);
    row.add(snapshot.contact_number, i);
    text += '\n';
  }
  return text;
}

std::string xyz_frame(const Snapshot& snapshot) {
  const auto& edges = snapshot.lattice.column;
  std::string text =
      fmt::format("{}\nLattice=\"{} {} {}\" Origin=\"{}\" ", snapshot.count(), spaced(edges[0]),
                  spaced(edges[1]), spaced(edges[2]), spaced(snapshot.corner));
  text += "Properties=id:I:1:type:S:1:pos:R:3:radius:R:1";
  if (!snapshot.velocity.empty()) text += ":velo:R:3";
  if (!snapshot.spin.empty()) text += ":angular_velocity:R:3";
  if (!snapshot.image.empty()) text += ":image:I:3";
  if (!snapshot.stress.empty()) text += ":stress:R:6";
  if (!snapshot.contact_number.empty()) text += ":contacts:I:1";
  text += fmt::format(" pbc=\"T T T\" Step={}", snapshot.step);
  if (snapshot.time) text += fmt::format(" Time={}", *snapshot.time);
  if (snapshot.strain) text += fmt::format(" Strain={}", *snapshot.strain);
  if (snapshot.velocity_gradient) {
    const auto& l = snapshot.velocity_gradient->column;
    text += fmt::format(" Velocity_gradient=\"{} {} {}\"", spaced(l[0]), spaced(l[1]), spaced(l[2]));
  }
  for (const auto& [term, t] : snapshot.stress_of_cell) {
    text += fmt::format(" stress_{}=\"{} {} {} {} {} {}\"", term, t.xx, t.yy, t.zz, t.xy, t.xz, t.yz);
  }
  text += '\n';
  const std::vector<std::string> types = words_of_species(snapshot);
  RowText row(text, snapshot.single);
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    fmt::format_to(std::back_inserter(text), "{} {}", i, types[snapshot.species[i]]);
    row.add(snapshot.position[i]);
    row.add(snapshot.radius[i]);
    row.add(snapshot.velocity, i);
    row.add(snapshot.spin, i);
    row.add(snapshot.image, i);
    row.add(snapshot.stress, i);
    row.add(snapshot.contact_number, i);
    text += '\n';
  }
  return text;
}

std::string convert_trajectory(const ConversionOptions& options) {
  const FrameText text = text_of(options);
  const std::filesystem::path output = options.output.empty() ? "/dev/stdout" : options.output;
  check_output(output);
  const SnapshotFile file(options.file);
  const std::vector<std::uint64_t> frames = chosen_frames(options.frames, file, "--frames");
  bool has_sizes = true;
  for (const std::uint64_t frame : frames) {
    const Snapshot snapshot = file.read(frame);
    has_sizes = has_sizes && snapshot.has_sizes;
    if (text == lammps_frame && is_turned(snapshot)) {
      throw InputError(options.file, "", "",
                       "has a cell whose first edge is not along x, which a dump of LAMMPS cannot hold: "
                       "--format must be xyz");
    }
  }
  auto next = frames.begin();
  write_output(output, [&] { return next == frames.end() ? std::string() : text(file.read(*next++)); });
  return has_sizes ? "" : note_on_sizes(options.file);
}

}  // namespace peclet::engine
