#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "contract/errors.h"
#include "contract/text.h"
#include "engine/snapshots/snapshot.h"
#include "engine/snapshots/sphere_text.h"

namespace peclet::engine {
namespace {

// The columns that are read, by name and width; others are ignored.
enum class Field { none, id, species, position, radius, velocity, spin, image, stress, contacts };

struct Column {
  std::string_view name;
  std::size_t width;
  Field field;
};

// This program writes `type`, because other programs expect chemical symbols in a column `species`.
constexpr std::array<Column, 10> known_columns = {{{"id", 1, Field::id},
                                                   {"type", 1, Field::species},
                                                   {"species", 1, Field::species},
                                                   {"pos", 3, Field::position},
                                                   {"radius", 1, Field::radius},
                                                   {"velo", 3, Field::velocity},
                                                   {"angular_velocity", 3, Field::spin},
                                                   {"image", 3, Field::image},
                                                   {"stress", 6, Field::stress},
                                                   {"contacts", 1, Field::contacts}}};

class XyzReading : SphereText {
 public:
  XyzReading(std::string_view frame, const std::string& file) : SphereText(file), rest_(frame) {}

  Snapshot read() {
    std::string_view first = take_line(rest_);
    const auto count = number<std::size_t>(take_word(first), "the number of spheres");
    read_keys(take_line(rest_));
    Snapshot snapshot;
    read_about(snapshot);
    read_columns();
    for (std::size_t row = 0; row < count; ++row) read_sphere(take_line(rest_), row, snapshot);
    finish(snapshot, id_);
    return snapshot;
  }

 private:
  // Splits the second line: NAME=VALUE NAME="VALUE" NAME='VALUE' ... Ignores words without a value.
  void read_keys(std::string_view about) {
    while (!is_blank(about)) {
      about.remove_prefix(about.find_first_not_of(" \t"));
      const std::size_t end = about.find_first_of(" \t=");
      const std::string_view name = about.substr(0, end);
      about.remove_prefix(name.size());
      if (!about.starts_with('=')) continue;
      about.remove_prefix(1);
      const bool is_quoted = about.starts_with('"') || about.starts_with('\'');
      if (!is_quoted) {
        keys_.emplace_back(name, about.substr(0, about.find_first_of(" \t")));
        about.remove_prefix(keys_.back().second.size());
        continue;
      }
      const std::size_t close = about.find(about[0], 1);
      if (close == std::string_view::npos)
        refuse(std::string(name), "must end its value with a quotation mark");
      keys_.emplace_back(name, about.substr(1, close - 1));
      about.remove_prefix(close + 1);
    }
  }

  // Returns the value of a key of the second line, or an empty text.
  std::string_view value_of(std::string_view name) const {
    std::string_view value;
    bool is_there = false;
    for (const auto& [key, text] : keys_) {
      if (key != name) continue;
      if (is_there) refuse(std::string(name), "must be in the second line of a frame once");
      is_there = true;
      value = text;
    }
    return value;
  }

  Matrix3 matrix(std::string_view words, const std::string& what) const {
    Matrix3 m;
    for (Vector3& column : m.column) column = vector(words, what);
    if (!is_blank(words)) refuse(what, "must be nine numbers");
    return m;
  }

  void read_about(Snapshot& snapshot) const {
    const std::string_view lattice = value_of("Lattice");
    if (lattice.empty())
      refuse("Lattice", "must be in the second line of a frame: extended XYZ has the cell there");
    snapshot.lattice = matrix(lattice, "Lattice");
    if (std::string_view origin = value_of("Origin"); !origin.empty())
      snapshot.corner = vector(origin, "Origin");
    if (const auto step = value_of("Step"); !step.empty())
      snapshot.step = number<std::uint64_t>(step, "Step");
    if (const auto time = value_of("Time"); !time.empty()) snapshot.time = number<double>(time, "Time");
    if (const auto strain = value_of("Strain"); !strain.empty()) {
      snapshot.strain = number<double>(strain, "Strain");
    }
    if (const auto gradient = value_of("Velocity_gradient"); !gradient.empty()) {
      snapshot.velocity_gradient = matrix(gradient, "Velocity_gradient");
    }
  }

  void read_columns() {
    std::string_view properties = value_of("Properties");
    const auto next = [&] {
      const std::size_t end = properties.find(':');
      const std::string_view part = properties.substr(0, end);
      properties.remove_prefix(end == std::string_view::npos ? properties.size() : end + 1);
      return part;
    };
    std::set<std::string_view> names;
    std::set<Field> fields;
    while (!properties.empty()) {
      const std::string_view name = next(), kind = next();
      const auto width = number<std::size_t>(next(), "Properties");
      if (kind.size() != 1 || width < 1 || width > 1000)
        refuse("Properties", "must be names, types and columns");
      const auto* const known = std::ranges::find_if(
          known_columns, [&](const Column& c) { return c.name == name && c.width == width; });
      const Field field = known == known_columns.end() ? Field::none : known->field;
      const bool is_new = names.insert(name).second && (field == Field::none || fields.insert(field).second);
      if (!is_new) refuse(fmt::format("Properties: {}", name), "must be there once");
      columns_.push_back({name, width, field});
    }
    if (!fields.contains(Field::position) || !fields.contains(Field::radius)) {
      refuse("Properties", "must have pos:R:3 and radius:R:1, centres and radii");
    }
  }

  void read_sphere(std::string_view line, std::size_t row, Snapshot& snapshot) {
    const std::string where = "sphere " + std::to_string(row + 1);
    for (const Column& column : columns_) take(column, line, where, snapshot);
    if (!is_blank(line)) refuse(where, "must have the columns of Properties, and no more");
  }

  // Reads one column of a sphere from its line, as one entry of its list.
  void take(const Column& column, std::string_view& line, const std::string& where, Snapshot& snapshot) {
    switch (column.field) {
      case Field::id:
        return id_.push_back(number<std::int64_t>(take_word(line), where));
      case Field::species:
        return snapshot.species.push_back(species(take_word(line), where, snapshot));
      case Field::position:
        return snapshot.position.push_back(vector(line, where));
      case Field::radius:
        return snapshot.radius.push_back(number<double>(take_word(line), where));
      case Field::velocity:
        return snapshot.velocity.push_back(vector(line, where));
      case Field::spin:
        return snapshot.spin.push_back(vector(line, where));
      case Field::image: {
        LatticeShift shift;
        for (std::int32_t* const k : {&shift.x, &shift.y, &shift.z})
          *k = number<std::int32_t>(take_word(line), where);
        return snapshot.image.push_back(shift);
      }
      case Field::stress: {
        SymmetricTensor t;
        for (double* const x : {&t.xx, &t.yy, &t.zz, &t.xy, &t.xz, &t.yz})
          *x = number<double>(take_word(line), where);
        return snapshot.stress.push_back(t);
      }
      case Field::contacts:
        return snapshot.contact_number.push_back(number<std::uint32_t>(take_word(line), where));
      case Field::none:
        break;
    }
    for (std::size_t k = 0; k < column.width; ++k) {
      if (take_word(line).empty()) refuse(where, "must have a value for {}", column.name);
    }
  }

  std::string_view rest_;
  std::vector<std::pair<std::string_view, std::string_view>> keys_;  // keys and values of the second line
  std::vector<Column> columns_;
  std::vector<std::int64_t> id_;
};

}  // namespace

std::vector<std::string_view> xyz_frames(std::string_view text, const std::string& file) {
  std::vector<std::string_view> frames;
  text = without_byte_order_mark(text);
  while (!is_blank(text)) {
    std::string_view rest = text;
    std::string_view line = take_line(rest);
    const std::string_view word = take_word(line);
    const auto count = number_in<std::size_t>(word);
    if (!count || *count < 1 || *count > most_spheres) {
      throw InputError(
          file, "", fmt::format("frame {} begins with \"{}\"", frames.size(), word.substr(0, 40)),
          fmt::format("must be GSD, a dump or data file of LAMMPS, a configuration of LF_DEM, or "
                      "extended XYZ whose frames begin with the number of their spheres, 1 to {}",
                      most_spheres));
    }
    for (std::size_t left = *count + 1; left > 0; --left) {
      if (rest.empty()) {
        throw InputError(file, "", fmt::format("frame {}", frames.size()),
                         fmt::format("must have {} lines after the first; {} are missing", *count + 1, left));
      }
      take_line(rest);
    }
    frames.push_back(text.substr(0, text.size() - rest.size()));
    text = rest;
  }
  return frames;
}

Snapshot read_xyz_frame(std::string_view frame, const std::string& file) {
  return XyzReading(frame, file).read();
}

}  // namespace peclet::engine
