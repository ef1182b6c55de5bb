#include "engine/snapshots/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/text.h"

namespace peclet::engine {
namespace {

// Limits that keep sixth powers of lengths and quotients of numbers within the range of a double.
constexpr double largest = 1e30, least_length = 1e-30, least_time = 1e-30;
constexpr double finest = 1e-6, most_cells = 1e6;

// Returns false for NaN, as do all comparisons here.
bool is_number(double x) { return std::abs(x) <= largest; }
bool is_vector(const Vector3& v) { return is_number(v.x) && is_number(v.y) && is_number(v.z); }

bool is_part_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '/';
}

std::string text_of(const Vector3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

class Check {
 public:
  Check(const Snapshot& snapshot, const std::string& file) : snapshot_(snapshot), file_(file) {}

  void run() {
    check_cell();
    check_spheres();
    check_single_numbers();
    for (std::size_t i = 0; i < snapshot_.count(); ++i) {
      if (!snapshot_.velocity.empty()) check_vector(snapshot_.velocity[i], "velocity", i);
      if (!snapshot_.spin.empty()) check_vector(snapshot_.spin[i], "angular velocity", i);
      if (!snapshot_.stress.empty())
        check_tensor(snapshot_.stress[i], [i] { return fmt::format("stress of sphere {}", i); });
    }
    for (const auto& [term, stress] : snapshot_.stress_of_cell) {
      if (!std::ranges::all_of(term, is_part_of_name))
        refuse("stress " + term, "must have a name of letters, digits, '_', '-' and '/'");
      check_tensor(stress, [name = "stress " + term] { return name; });
    }
    if (snapshot_.contacts) check_contacts(*snapshot_.contacts);
  }

 private:
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& value, fmt::format_string<Arguments...> rule,
                           Arguments&&... arguments) const {
    throw InputError(file_, "", value, fmt::format(rule, std::forward<Arguments>(arguments)...));
  }

  void check_number(double x, const std::string& what) const {
    if (!is_number(x))
      refuse(fmt::format("{} {:.6g}", what, x), "must be from {:g} to {:g}", -largest, largest);
  }

  void check_vector(const Vector3& v, const char* what, std::size_t sphere) const {
    if (is_vector(v)) return;
    refuse(fmt::format("{} {} of sphere {}", what, text_of(v), sphere), "must have numbers from {:g} to {:g}",
           -largest, largest);
  }

  template <class Name>
  void check_tensor(const SymmetricTensor& t, const Name& name) const {
    for (const double x : {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}) {
      if (!is_number(x)) check_number(x, name());
    }
  }

  void check_cell() {
    const auto& [a, b, c] = snapshot_.lattice.column;
    for (const Vector3& edge : snapshot_.lattice.column) longest_ = std::max(longest_, norm(edge));
    cell_ = PeriodicCell::with_edges(snapshot_.lattice, Matrix3{}).frame();
    const Vector3& across = cell_.lengths;
    const bool is_cell = is_vector(a) && is_vector(b) && is_vector(c) && longest_ >= least_length &&
                         longest_ <= largest && std::min({across.x, across.y, across.z}) >= finest * longest_;
    if (!is_cell) {
      refuse(fmt::format("cell {} {} {}", text_of(a), text_of(b), text_of(c)),
             "must have three edges of different directions, from {:g} to {:g} long, none of them "
             "less than a millionth of another",
             least_length, largest);
    }
    check_place(snapshot_.corner, [] { return std::string("corner of the cell"); });
  }

  template <class Name>
  void check_place(const Vector3& place, const Name& name) const {
    const Vector3 cells = cell_.fractional(place);
    const auto is_near = [](double x) { return std::abs(x) <= most_cells; };
    if (is_near(cells.x) && is_near(cells.y) && is_near(cells.z)) return;
    refuse(fmt::format("{} at {}", name(), text_of(place)), "must be within a million cells of the origin");
  }

  void check_spheres() const {
    for (std::size_t i = 0; i < snapshot_.count(); ++i) {
      check_place(snapshot_.position[i], [&] { return fmt::format("sphere {}", i); });
      const double a = snapshot_.radius[i];
      if (a >= finest * longest_ && a <= longest_) continue;
      refuse(fmt::format("radius {:.6g} of sphere {}", a, i),
             "must be > 0, from {:.6g} to {:.6g}: a millionth of the longest edge of the cell and "
             "that edge{}",
             finest * longest_, longest_,
             snapshot_.has_sizes ? "" : "; the file has no diameters, so the diameter is 1");
    }
  }

  void check_single_numbers() const {
    if (snapshot_.strain) check_number(*snapshot_.strain, "strain");
    if (snapshot_.time) {
      check_number(*snapshot_.time, "time");
      if (*snapshot_.time != 0 && std::abs(*snapshot_.time) < least_time) {
        refuse(fmt::format("time {:.6g}", *snapshot_.time), "must be 0 or at least {:g}", least_time);
      }
    }
    if (!snapshot_.velocity_gradient) return;
    for (const Vector3& column : snapshot_.velocity_gradient->column) {
      for (const double x : {column.x, column.y, column.z}) check_number(x, "velocity gradient");
    }
  }

  void check_contacts(const std::vector<SnapshotContact>& contacts) const {
    for (const SnapshotContact& contact : contacts) {
      const bool is_good = std::max(contact.first, contact.second) < snapshot_.count() &&
                           contact.first != contact.second && contact.normal_force >= 0 &&
                           is_number(contact.normal_force) && is_number(contact.tangential_force);
      if (is_good) continue;
      refuse(fmt::format("contact of {} and {}: forces {:.6g} and {:.6g}", contact.first, contact.second,
                         contact.normal_force, contact.tangential_force),
             "must be of two different spheres below {}, with forces up to {:g}, the normal one not "
             "negative",
             snapshot_.count(), largest);
    }
  }

  const Snapshot& snapshot_;
  const std::string& file_;
  CellFrame cell_{};
  double longest_ = 0;
};

constexpr InputLimits text_limits{std::size_t{256} << 20, 0};

std::int64_t whole(std::string_view text, std::int64_t missing, const std::string& range,
                   const std::string& option) {
  if (text.empty()) return missing;
  std::int64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc() && read.ptr == text.data() + text.size()) return value;
  throw InputError(option, "", range, "must be FIRST:LAST:STEP or one frame, whole numbers");
}

}  // namespace

void check_snapshot(const Snapshot& snapshot, const std::string& file) { Check(snapshot, file).run(); }

void arrange(Snapshot& snapshot, const std::vector<std::size_t>& order) {
  const auto arrange_list = [&](auto& values) {
    if (values.empty()) return;
    auto arranged = values;
    for (std::size_t k = 0; k < order.size(); ++k) arranged[k] = values[order[k]];
    values = std::move(arranged);
  };
  arrange_list(snapshot.position);
  arrange_list(snapshot.radius);
  arrange_list(snapshot.species);
  arrange_list(snapshot.velocity);
  arrange_list(snapshot.spin);
  arrange_list(snapshot.image);
  arrange_list(snapshot.stress);
  arrange_list(snapshot.contact_number);
  snapshot.contacts.reset();
}

std::string note_on_sizes(const std::string& file) {
  return file + " has no diameters (particles/diameter): its spheres are shown with the diameter 1";
}

SnapshotFile::Text::Text(const std::filesystem::path& path) : text(read_input(path, text_limits)) {
  const std::string_view plain = without_byte_order_mark(text);
  if (plain.starts_with("ITEM:")) {
    frames = lammps_dump_frames(plain, path.string());
    read = read_lammps_dump_frame;
  } else if (begins_as_lammps_data(plain)) {
    frames = {plain};
    read = read_lammps_data;
  } else if (plain.starts_with('#')) {
    frames = {plain};
    read = read_lf_dem;
  } else {
    frames = xyz_frames(plain, path.string());
    read = read_xyz_frame;
  }
}

SnapshotFile::SnapshotFile(const std::filesystem::path& path) : path_(path) {
  if (gsd::begins_as_gsd(path)) {
    gsd_.emplace(path);
  } else {
    text_ = std::make_unique<Text>(path);
  }
  if (frames() == 0) throw InputError(path.string(), "", "", "must have at least one frame");
}

std::uint64_t SnapshotFile::frames() const { return gsd_ ? gsd_->frames() : text_->frames.size(); }

std::uint64_t SnapshotFile::index_of(std::int64_t frame) const {
  const auto count = static_cast<std::int64_t>(frames());
  const std::int64_t index = frame < 0 ? frame + count : frame;
  if (index < 0 || index >= count) {
    throw InputError(path_.string(), "", fmt::format("frame {}", frame),
                     fmt::format("must be from 0 to {}, or from -1, the last one, to {}", count - 1, -count));
  }
  return static_cast<std::uint64_t>(index);
}

Snapshot SnapshotFile::read(std::uint64_t frame) const {
  return gsd_ ? read_gsd_frame(*gsd_, frame) : text_->read(text_->frames.at(frame), path_.string());
}

std::vector<std::uint64_t> chosen_frames(const std::string& range, const SnapshotFile& file,
                                         const std::string& option) {
  std::vector<std::string_view> parts;
  for (std::string_view rest = range;;) {
    const std::size_t end = rest.find(':');
    parts.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (range.empty() || parts.size() > 3) whole("-", 0, range, option);
  const std::uint64_t first = file.index_of(whole(parts[0], 0, range, option));
  if (parts.size() == 1) return {first};
  const std::uint64_t last = file.index_of(whole(parts[1], -1, range, option));
  const std::int64_t step = parts.size() == 3 ? whole(parts[2], 1, range, option) : 1;
  if (step < 1 || last < first) {
    throw InputError(option, "", range,
                     "must have its first frame before its last one, and a step of 1 or more");
  }
  std::vector<std::uint64_t> frames;
  for (std::uint64_t k = first; k <= last; k += static_cast<std::uint64_t>(step)) frames.push_back(k);
  return frames;
}

}  // namespace peclet::engine
