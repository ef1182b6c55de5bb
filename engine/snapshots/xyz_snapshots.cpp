#include "engine/snapshots/xyz_snapshots.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "contract/input_error.h"

namespace peclet::engine {
namespace {

std::string_view line_of(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view word_of(std::string_view& line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  const auto begin = std::ranges::find_if_not(line, blank);
  const auto end = std::find_if(begin, line.end(), blank);
  const std::string_view word(begin, end);
  line.remove_prefix(static_cast<std::size_t>(end - line.begin()));
  return word;
}

class XyzReading {
 public:
  XyzReading(std::string_view frame, std::string file) : rest_(frame), file_(std::move(file)) {}

  Snapshot read() {
    const auto count = number<std::size_t>(line_of(rest_), "the number of spheres");
    const std::string_view about = line_of(rest_);
    Snapshot snapshot;
    read_about(about, snapshot);
    read_columns(about);
    for (std::size_t row = 0; row < count; ++row) read_sphere(line_of(rest_), row, snapshot);
    sort(snapshot);
    return snapshot;
  }

 private:
  struct Column {
    std::string name;
    std::size_t width;
  };

  [[noreturn]] void refuse(const std::string& value, const std::string& rule) const {
    throw InputError(file_, "", value, rule);
  }

  template <class Number>
  Number number(std::string_view word, const std::string& what) const {
    Number value{};
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    bool is_good = read.ec == std::errc() && read.ptr == word.data() + word.size();
    if constexpr (std::is_floating_point_v<Number>) is_good = is_good && std::isfinite(value);
    if (!is_good) refuse(fmt::format("{}: \"{}\"", what, word), "must be a number");
    return value;
  }

  // The value of a key of the second line, without its quotes; empty where there is none.
  static std::string_view value_of(std::string_view about, std::string_view key) {
    for (std::size_t at = about.find(key); at != std::string_view::npos; at = about.find(key, at + 1)) {
      const std::size_t after = at + key.size();
      const bool is_whole = (at == 0 || about[at - 1] == ' ') && after < about.size() && about[after] == '=';
      if (!is_whole) continue;
      std::string_view value = about.substr(after + 1);
      if (!value.starts_with('"')) return value.substr(0, value.find(' '));
      value.remove_prefix(1);
      return value.substr(0, value.find('"'));
    }
    return {};
  }

  Vector3 vector(std::string_view& words, const std::string& what) const {
    Vector3 v;
    for (double* const x : {&v.x, &v.y, &v.z}) *x = number<double>(word_of(words), what);
    return v;
  }

  void read_about(std::string_view about, Snapshot& snapshot) const {
    std::string_view lattice = value_of(about, "Lattice");
    if (lattice.empty())
      refuse("Lattice", "must be in the second line of a frame: extended XYZ has the cell there");
    for (Vector3& edge : snapshot.lattice.column) edge = vector(lattice, "Lattice");
    const auto& [a, b, c] = snapshot.lattice.column;
    if (a.y != 0 || a.z != 0 || b.z != 0 || !(std::min({a.x, b.y, c.z}) > 0)) {
      refuse(fmt::format("Lattice \"{}\"", value_of(about, "Lattice")),
             "must have its first vector along x, the second in the plane of x and y, and three lengths > 0");
    }
    if (std::string_view origin = value_of(about, "Origin"); !origin.empty())
      snapshot.corner = vector(origin, "Origin");
    if (const auto step = value_of(about, "Step"); !step.empty())
      snapshot.step = number<std::uint64_t>(step, "Step");
    if (const auto time = value_of(about, "Time"); !time.empty())
      snapshot.time = number<double>(time, "Time");
    if (const auto strain = value_of(about, "Strain"); !strain.empty()) {
      snapshot.strain = number<double>(strain, "Strain");
    }
  }

  void read_columns(std::string_view about) {
    std::string_view properties = value_of(about, "Properties");
    const auto next = [&] {
      const std::size_t end = properties.find(':');
      const std::string_view part = properties.substr(0, end);
      properties.remove_prefix(end == std::string_view::npos ? properties.size() : end + 1);
      return part;
    };
    const auto has = [&](const char* name, std::size_t width) {
      return std::ranges::any_of(columns_,
                                 [&](const Column& c) { return c.name == name && c.width == width; });
    };
    while (!properties.empty()) {
      const std::string_view name = next(), kind = next();
      const auto width = number<std::size_t>(next(), "Properties");
      if (kind.size() != 1 || width < 1 || width > 1000)
        refuse("Properties", "must be names, types and columns");
      columns_.push_back({std::string(name), width});
    }
    if (!has("pos", 3) || !has("radius", 1)) {
      refuse("Properties", "must have pos:R:3 and radius:R:1, centres and radii");
    }
  }

  void read_sphere(std::string_view line, std::size_t row, Snapshot& snapshot) {
    const std::string where = "sphere " + std::to_string(row + 1);
    for (const Column& column : columns_) {
      const auto is = [&](const char* name, std::size_t width) {
        return column.name == name && column.width == width;
      };
      if (is("id", 1)) {
        id_.push_back(number<std::int64_t>(word_of(line), where));
      } else if (is("species", 1)) {
        snapshot.species.push_back(species(word_of(line), snapshot));
      } else if (is("pos", 3)) {
        snapshot.position.push_back(vector(line, where));
      } else if (is("radius", 1)) {
        snapshot.radius.push_back(number<double>(word_of(line), where));
        if (!(snapshot.radius.back() > 0)) refuse(where, "must have a radius > 0");
      } else if (is("velo", 3)) {
        snapshot.velocity.push_back(vector(line, where));
      } else if (is("angular_velocity", 3)) {
        snapshot.spin.push_back(vector(line, where));
      } else if (is("image", 3)) {
        LatticeShift shift;
        for (std::int32_t* const k : {&shift.x, &shift.y, &shift.z})
          *k = number<std::int32_t>(word_of(line), where);
        snapshot.image.push_back(shift);
      } else if (is("stress", 6)) {
        SymmetricTensor t;
        for (double* const x : {&t.xx, &t.yy, &t.zz, &t.xy, &t.xz, &t.yz})
          *x = number<double>(word_of(line), where);
        snapshot.stress.push_back(t);
      } else if (is("contacts", 1)) {
        snapshot.contact_number.push_back(number<std::uint32_t>(word_of(line), where));
      } else {
        for (std::size_t k = 0; k < column.width; ++k) word_of(line);
      }
    }
    if (!word_of(line).empty())
      refuse(where, fmt::format("must have the columns of Properties, and no more"));
  }

  std::uint32_t species(std::string_view name, Snapshot& snapshot) const {
    std::vector<std::string>& names = snapshot.species_names;
    const auto known = std::ranges::find(names, name);
    if (known != names.end()) return static_cast<std::uint32_t>(known - names.begin());
    if (names.size() == most_species) refuse("species", fmt::format("must be at most {}", most_species));
    names.emplace_back(name);
    return static_cast<std::uint32_t>(names.size() - 1);
  }

  // By ids, where there are some; a number that is there twice names nobody.
  void sort(Snapshot& snapshot) const {
    if (snapshot.species.empty()) name_by_radius(snapshot);
    if (id_.empty()) return;
    std::vector<std::size_t> order(id_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t row) { return id_[row]; });
    const auto twice = std::ranges::adjacent_find(order, {}, [&](std::size_t row) { return id_[row]; });
    if (twice != order.end()) refuse(fmt::format("id {}", id_[*twice]), "must be there once");
    const auto arrange = [&](auto& values) {
      if (values.empty()) return;
      auto sorted = values;
      for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
      values = std::move(sorted);
    };
    arrange(snapshot.position);
    arrange(snapshot.radius);
    arrange(snapshot.species);
    arrange(snapshot.velocity);
    arrange(snapshot.spin);
    arrange(snapshot.image);
    arrange(snapshot.stress);
    arrange(snapshot.contact_number);
  }

  // Where no species are told apart, sizes are.
  static void name_by_radius(Snapshot& snapshot) {
    std::vector<double> sizes = snapshot.radius;
    std::ranges::sort(sizes);
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    for (const double size : sizes) snapshot.species_names.push_back(fmt::format("a = {}", size));
    for (const double a : snapshot.radius) {
      snapshot.species.push_back(
          static_cast<std::uint32_t>(std::ranges::lower_bound(sizes, a) - sizes.begin()));
    }
  }

  std::string_view rest_;
  std::string file_;
  std::vector<Column> columns_;
  std::vector<std::int64_t> id_;
};

}  // namespace

std::vector<std::string_view> xyz_frames(std::string_view text, const std::string& file) {
  std::vector<std::string_view> frames;
  while (!text.empty()) {
    std::string_view rest = text;
    std::string_view first = line_of(rest);
    if (word_of(first).empty() && rest.empty()) break;  // an empty line at the end
    std::string_view line = text.substr(0, text.find('\n'));
    const std::string_view word = word_of(line);
    std::size_t count = 0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), count);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size() || count < 1 ||
        count > most_spheres) {
      throw InputError(file, "",
                       fmt::format("frame {} begins with \"{}\"", frames.size(), word.substr(0, 40)),
                       fmt::format("must be a GSD file, or extended XYZ, of which a frame begins with the "
                                   "number of its spheres, 1 to {}",
                                   most_spheres));
    }
    for (std::size_t left = count + 1; left > 0; --left) {
      if (rest.empty()) {
        throw InputError(
            file, "", fmt::format("frame {}", frames.size()),
            fmt::format("must have {} lines after the first, and ends {} before", count + 1, left));
      }
      line_of(rest);
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
