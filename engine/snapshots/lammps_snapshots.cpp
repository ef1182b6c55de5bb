#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "contract/errors.h"
#include "contract/text.h"
#include "engine/snapshots/snapshot.h"
#include "engine/snapshots/sphere_text.h"

namespace peclet::engine {
namespace {

// The number of atoms in a frame of a dump, and the lines after it.
constexpr std::string_view count_item = "ITEM: NUMBER OF ATOMS", atoms_item = "ITEM: ATOMS";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) words.push_back(word);
  return words;
}

std::vector<std::string_view> words_before_comment(std::string_view line) {
  return words_of(line.substr(0, line.find('#')));
}

// Returns N of the line "N atoms" of a data file.
std::optional<std::size_t> count_of_atoms(const std::vector<std::string_view>& words) {
  if (words.size() != 2 || words[1] != "atoms") return std::nullopt;
  return number_in<std::size_t>(words[0]);
}

Matrix3 tilted_cell(const Vector3& lengths, double xy, double xz, double yz) {
  return {Vector3{lengths.x, 0, 0}, Vector3{xy, lengths.y, 0}, Vector3{xz, yz, lengths.z}};
}

class LammpsText : protected SphereText {
 protected:
  using SphereText::SphereText;

  // Throws InputError unless every edge has a length.
  void require_order(const std::string& name, const Vector3& low, const Vector3& high) const {
    if (low.x < high.x && low.y < high.y && low.z < high.z) return;
    refuse(name, "must be there, with the lower end of each edge first");
  }
};

class DumpReading : LammpsText {
 public:
  DumpReading(std::string_view frame, const std::string& file) : LammpsText(file), rest_(frame) {}

  Snapshot read() {
    std::size_t count = 0;
    while (true) {
      const std::string_view line = take_line(rest_);
      if (line.starts_with("ITEM: TIMESTEP")) {
        snapshot_.step = number<std::uint64_t>(take_line_word(), "TIMESTEP");
      } else if (line.starts_with("ITEM: TIME")) {
        snapshot_.time = number<double>(take_line_word(), "TIME");
      } else if (line.starts_with(count_item)) {
        count = number<std::size_t>(take_line_word(), "NUMBER OF ATOMS");
      } else if (line.starts_with("ITEM: BOX BOUNDS")) {
        read_box(words_of(line));
      } else if (line.starts_with(atoms_item)) {
        read_columns(words_of(line.substr(atoms_item.size())));
        break;
      } else if (line.starts_with("ITEM: UNITS")) {
        take_line(rest_);
      } else {
        refuse(printable(line, 60),
               "must be an ITEM of a dump that is known: TIMESTEP, TIME, UNITS, NUMBER OF "
               "ATOMS, BOX BOUNDS or ATOMS");
      }
    }
    if (!has_box_) refuse("ITEM: BOX BOUNDS", "must be there");
    for (std::size_t row = 0; row < count; ++row) read_sphere(words_of(take_line(rest_)), row);
    finish(snapshot_, id_);
    return std::move(snapshot_);
  }

 private:
  std::string_view take_line_word() {
    std::string_view line = take_line(rest_);
    return take_word(line);
  }

  // Reads the bounds; those of a tilted box surround the tilted cell.
  void read_box(const std::vector<std::string_view>& title) {
    const bool is_tilted = title.size() > 5 && title[3] == "xy" && title[4] == "xz" && title[5] == "yz";
    const std::vector<std::string_view> boundaries(title.begin() + (is_tilted ? 6 : 3), title.end());
    if (boundaries != std::vector<std::string_view>(3, "pp")) {
      refuse(fmt::format("ITEM: BOX BOUNDS {}", fmt::join(title.begin() + 3, title.end(), " ")),
             "must be followed by pp pp pp, or xy xz yz pp pp pp: other boxes are not read");
    }
    Vector3 low, high;
    std::array<double, 3> tilt{};  // xy, xz, yz
    std::size_t axis = 0;
    for (auto [from, to] : {std::pair{&low.x, &high.x}, {&low.y, &high.y}, {&low.z, &high.z}}) {
      std::string_view line = take_line(rest_);
      *from = number<double>(take_word(line), "BOX BOUNDS");
      *to = number<double>(take_word(line), "BOX BOUNDS");
      if (is_tilted) tilt.at(axis) = number<double>(take_word(line), "BOX BOUNDS");
      ++axis;
    }
    const auto [xy, xz, yz] = tilt;
    low.x -= std::min({0.0, xy, xz, xy + xz});
    high.x -= std::max({0.0, xy, xz, xy + xz});
    low.y -= std::min(0.0, yz);
    high.y -= std::max(0.0, yz);
    require_order("BOX BOUNDS", low, high);
    has_box_ = true;
    snapshot_.corner = low;
    snapshot_.lattice = tilted_cell(high - low, xy, xz, yz);
  }

  void read_columns(const std::vector<std::string_view>& names) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!column_.emplace(names[k], k).second)
        refuse(fmt::format("ITEM: ATOMS: {}", names[k]), "must be there once");
    }
    for (const std::string_view ending : {"", "u", "s", "su"}) {
      names_of_position_.clear();
      for (const char axis : {'x', 'y', 'z'}) names_of_position_.push_back(fmt::format("{}{}", axis, ending));
      is_scaled_ = ending.starts_with('s');
      // Unwrapped positions have the images in them.
      has_images_ = !ending.ends_with('u') && has({"ix", "iy", "iz"});
      if (has(names_of_position_)) break;
    }
    if (!has(names_of_position_) || !(column_.contains("radius") || column_.contains("diameter"))) {
      refuse("ITEM: ATOMS", "must have x y z (or xu, xs, xsu ...) and radius or diameter");
    }
    has_velocity_ = has({"vx", "vy", "vz"});
    has_spin_ = has({"omegax", "omegay", "omegaz"});
    has_stress_ = has({"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz"});
  }

  bool has(const std::vector<std::string>& names) const {
    return std::ranges::all_of(names, [&](const std::string& name) { return column_.contains(name); });
  }

  void read_sphere(const std::vector<std::string_view>& words, std::size_t row) {
    const std::string where = fmt::format("sphere {}", row + 1);
    if (words.size() != column_.size()) refuse(where, "must have the columns of ITEM: ATOMS, and no more");
    const auto word = [&](std::string_view name) { return words[column_.find(name)->second]; };
    const auto real = [&](std::string_view name) { return number<double>(word(name), where); };
    const std::vector<std::string>& axes = names_of_position_;
    const Vector3 place = {real(axes[0]), real(axes[1]), real(axes[2])};
    const auto& [a, b, c] = snapshot_.lattice.column;
    snapshot_.position.push_back(is_scaled_ ? snapshot_.corner + place.x * a + place.y * b + place.z * c
                                            : place);
    snapshot_.radius.push_back(column_.contains("radius") ? real("radius") : 0.5 * real("diameter"));
    if (column_.contains("id")) id_.push_back(number<std::int64_t>(word("id"), where));
    if (column_.contains("type")) snapshot_.species.push_back(species(word("type"), where, snapshot_));
    if (has_velocity_) snapshot_.velocity.push_back({real("vx"), real("vy"), real("vz")});
    if (has_spin_) snapshot_.spin.push_back({real("omegax"), real("omegay"), real("omegaz")});
    if (has_images_) {
      const auto whole = [&](const char* name) { return number<std::int32_t>(word(name), where); };
      snapshot_.image.push_back({whole("ix"), whole("iy"), whole("iz")});
    }
    if (has_stress_) {
      snapshot_.stress.push_back({real("stress_xx"), real("stress_yy"), real("stress_zz"), real("stress_xy"),
                                  real("stress_xz"), real("stress_yz")});
    }
    if (column_.contains("contacts"))
      snapshot_.contact_number.push_back(number<std::uint32_t>(word("contacts"), where));
  }

  std::string_view rest_;
  Snapshot snapshot_;
  std::map<std::string_view, std::size_t> column_;  // place of each column in a line
  std::vector<std::string> names_of_position_;
  bool is_scaled_ = false;  // positions are fractions of the cell
  bool has_velocity_ = false, has_spin_ = false, has_images_ = false, has_stress_ = false, has_box_ = false;
  std::vector<std::int64_t> id_;
};

class DataReading : LammpsText {
 public:
  DataReading(std::string_view text, const std::string& file) : LammpsText(file), rest_(text) {}

  Snapshot read() {
    take_line(rest_);  // a title
    while (!is_blank(rest_)) {
      const std::string_view line = take_line(rest_);
      const std::vector<std::string_view> words = words_before_comment(line);
      if (words == std::vector<std::string_view>{"Atoms"}) {
        const std::string_view style = line.substr(std::min(line.find('#'), line.size() - 1) + 1);
        if (words_of(style) != std::vector<std::string_view>{"sphere"})
          refuse("Atoms", "must be \"Atoms # sphere\", of the atom style sphere, with its diameters");
        if (!id_.empty()) refuse("Atoms", "must be there once");
        read_atoms();
      } else if (words == std::vector<std::string_view>{"Velocities"}) {
        if (!motion_.empty()) refuse("Velocities", "must be there once");
        read_velocities();
      } else if (id_.empty() && motion_.empty()) {
        read_header(words, line);
      }
    }
    if (id_.empty()) refuse("Atoms", "must be a section of the file");
    require_order("xlo xhi, ylo yhi and zlo zhi", low_, high_);
    snapshot_.corner = low_;
    snapshot_.lattice = tilted_cell(high_ - low_, tilt_.x, tilt_.y, tilt_.z);
    sort_motion();
    finish(snapshot_, id_);
    return std::move(snapshot_);
  }

 private:
  // Reads a line of the header: count, edges and tilts; others are ignored.
  void read_header(const std::vector<std::string_view>& words, std::string_view line) {
    const auto real = [&](std::size_t k) { return number<double>(words[k], "header"); };
    const auto has = [&](std::string_view word) { return std::ranges::find(words, word) != words.end(); };
    const auto require_form = [&](std::size_t size, std::size_t place, std::string_view word) {
      if (words.size() != size || words[place] != word)
        refuse(printable(line, 60), "must be numbers before {}", word);
    };
    if (const auto count = count_of_atoms(words)) count_ = *count;
    if (has("avec") || has("bvec") || has("cvec") || has("abc"))
      refuse(printable(line, 60), "must not be there: general triclinic cells are not read");
    for (const auto& [name, low, high] :
         {std::tuple{"xlo", &low_.x, &high_.x}, {"ylo", &low_.y, &high_.y}, {"zlo", &low_.z, &high_.z}}) {
      if (!has(name)) continue;
      require_form(4, 2, name);
      *low = real(0);
      *high = real(1);
    }
    if (!has("xy")) return;
    require_form(6, 3, "xy");
    tilt_ = Vector3{real(0), real(1), real(2)};
  }

  // Calls read(words, where) with each line of a section: as many as there are atoms, after a blank one.
  template <class Read>
  void read_section(const char* name, const Read& read) {
    if (!is_blank(take_line(rest_))) refuse(name, "must be followed by an empty line");
    for (std::size_t row = 0; row < count_; ++row) {
      const std::string_view line = take_line(rest_);
      read(words_before_comment(line), fmt::format("{}, line {}", name, row + 1));
    }
    if (!rest_.empty() && !is_blank(take_line(rest_)))
      refuse(name, "must have {} lines, one for each of the atoms", count_);
  }

  void read_atoms() {
    read_section("Atoms", [&](const std::vector<std::string_view>& words, const std::string& where) {
      if (words.size() != 7 && words.size() != 10)
        refuse(where, "must be id, type, diameter, density, x, y, z and perhaps three image flags");
      id_.push_back(number<std::int64_t>(words[0], where));
      snapshot_.species.push_back(species(words[1], where, snapshot_));
      snapshot_.radius.push_back(0.5 * number<double>(words[2], where));
      snapshot_.position.push_back({number<double>(words[4], where), number<double>(words[5], where),
                                    number<double>(words[6], where)});
      if (words.size() == 7) return;
      const auto whole = [&](std::size_t k) { return number<std::int32_t>(words[k], where); };
      snapshot_.image.push_back({whole(7), whole(8), whole(9)});
    });
    if (!snapshot_.image.empty() && snapshot_.image.size() != count_)
      refuse("Atoms", "must have image flags in all lines, or in none");
  }

  void read_velocities() {
    read_section("Velocities", [&](const std::vector<std::string_view>& words, const std::string& where) {
      if (words.size() != 7) refuse(where, "must be id, velocity and angular velocity");
      const auto vector_from = [&](std::size_t k) {
        return Vector3{number<double>(words[k], where), number<double>(words[k + 1], where),
                       number<double>(words[k + 2], where)};
      };
      motion_[number<std::int64_t>(words[0], where)] = {vector_from(1), vector_from(4)};
    });
  }

  // Brings velocities into the order of the atoms.
  void sort_motion() {
    if (motion_.empty()) return;
    for (const std::int64_t id : id_) {
      const auto found = motion_.find(id);
      if (found == motion_.end()) refuse(fmt::format("Velocities: id {}", id), "must be there");
      snapshot_.velocity.push_back(found->second.first);
      snapshot_.spin.push_back(found->second.second);
    }
  }

  std::string_view rest_;
  Snapshot snapshot_;
  std::size_t count_ = 0;
  Vector3 low_, high_, tilt_;  // tilt: xy, xz, yz
  std::vector<std::int64_t> id_;
  std::map<std::int64_t, std::pair<Vector3, Vector3>> motion_;  // velocity and spin by id
};

}  // namespace

std::vector<std::string_view> lammps_dump_frames(std::string_view text, const std::string& file) {
  std::vector<std::string_view> frames;
  while (!is_blank(text)) {
    std::optional<std::size_t> count;
    bool has_atoms = false;
    while (text.starts_with('\n') || text.starts_with("\r\n")) take_line(text);
    std::string_view rest = text;
    while (!rest.empty() && !has_atoms) {
      const std::string_view line = take_line(rest);
      if (line.starts_with(count_item)) {
        std::string_view next = take_line(rest);
        count = number_in<std::size_t>(take_word(next));
      }
      has_atoms = line.starts_with(atoms_item);
    }
    const std::string frame = fmt::format("frame {}", frames.size());
    if (!has_atoms || !count || *count < 1 || *count > most_spheres) {
      throw InputError(
          file, "", frame,
          fmt::format("must have ITEM: NUMBER OF ATOMS, 1 to {}, and ITEM: ATOMS", most_spheres));
    }
    for (std::size_t left = *count; left > 0; --left) {
      if (rest.empty())
        throw InputError(file, "", frame, fmt::format("must have {} atoms; {} are missing", *count, left));
      take_line(rest);
    }
    frames.push_back(text.substr(0, text.size() - rest.size()));
    text = rest;
  }
  return frames;
}

Snapshot read_lammps_dump_frame(std::string_view frame, const std::string& file) {
  return DumpReading(frame, file).read();
}

bool begins_as_lammps_data(std::string_view text) {
  take_line(text);  // a title
  for (int line = 0; line < 20 && !text.empty(); ++line) {
    if (count_of_atoms(words_before_comment(take_line(text)))) return true;
  }
  return false;
}

Snapshot read_lammps_data(std::string_view text, const std::string& file) {
  return DataReading(text, file).read();
}

}  // namespace peclet::engine
