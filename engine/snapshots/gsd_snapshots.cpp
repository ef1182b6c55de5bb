#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/snapshots/snapshot.h"

namespace peclet::engine {
namespace {

class FrameReading {
 public:
  FrameReading(const gsd::Reader& file, std::uint64_t frame) : file_(file), frame_(frame) {}

  Snapshot read() {
    count_ = single<std::uint32_t>("particles/N", 0);
    if (count_ == 0 || count_ > most_spheres) {
      refuse("particles/N", std::to_string(count_), "must be 1 to {}", most_spheres);
    }
    Snapshot snapshot;
    snapshot.single = true;
    snapshot.step = single<std::uint64_t>("configuration/step", 0);
    if (own("log/time") != nullptr) snapshot.time = single<double>("log/time", 0);
    if (own("log/strain") != nullptr) snapshot.strain = single<double>("log/strain", 0);
    read_cell(snapshot);
    snapshot.position = vectors("particles/position");
    if (snapshot.position.empty()) refuse("particles/position", "missing", "must be there");
    read_spheres(snapshot);
    snapshot.velocity = vectors("particles/velocity");
    snapshot.spin = vectors("log/particles/angular_velocity");
    for (const auto& [x, y, z] : rows<std::int32_t, 3>("particles/image"))
      snapshot.image.push_back({x, y, z});
    for (const auto& [xx, yy, zz, xy, xz, yz] : rows<float, 6>("log/particles/stress")) {
      snapshot.stress.push_back({xx, yy, zz, xy, xz, yz});
    }
    for (const auto& [number] : rows<std::uint32_t, 1>("log/particles/contact_number")) {
      snapshot.contact_number.push_back(number);
    }
    read_contacts(snapshot);
    read_stress_of_cell(snapshot);
    check_snapshot(snapshot, file_.path().string());
    return snapshot;
  }

 private:
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& name, const std::string& value,
                           fmt::format_string<Arguments...> rule, Arguments&&... arguments) const {
    file_.refuse(fmt::format("{} of frame {}: {}", name, frame_, value), rule,
                 std::forward<Arguments>(arguments)...);
  }

  const gsd::IndexEntry* own(std::string_view name) const { return file_.find(frame_, name); }
  const gsd::IndexEntry* own_or_first(std::string_view name) const {
    const gsd::IndexEntry* const found = own(name);
    return found != nullptr ? found : file_.find(0, name);
  }

  template <class Value>
  Value single(const std::string& name, Value missing) const {
    const gsd::IndexEntry* const chunk = own_or_first(name);
    if (chunk == nullptr) return missing;
    if (chunk->rows != 1) refuse(name, fmt::format("{} rows", chunk->rows), "must be a single number");
    return file_.get<Value>(*chunk).front();
  }

  // Returns `columns` numbers for each sphere, or nothing if the file has none.
  template <class Value, std::uint32_t columns>
  std::vector<std::array<Value, columns>> rows(const std::string& name) const {
    const gsd::IndexEntry* chunk = own(name);
    if (chunk == nullptr) {
      chunk = file_.find(0, name);
      if (chunk == nullptr || chunk->rows != count_) return {};
    }
    if (chunk->rows != count_) {
      refuse(name, fmt::format("{} rows", chunk->rows), "must have one for each of {} spheres", count_);
    }
    const std::vector<Value> values = file_.get<Value>(*chunk, columns);
    std::vector<std::array<Value, columns>> all(count_);
    std::memcpy(all.data(), values.data(), values.size() * sizeof(Value));
    return all;
  }

  std::vector<Vector3> vectors(const std::string& name) const {
    std::vector<Vector3> all;
    for (const auto& [x, y, z] : rows<float, 3>(name)) all.push_back({x, y, z});
    return all;
  }

  // Computes in doubles, in which the numbers of the file are exact.
  void read_cell(Snapshot& snapshot) const {
    const gsd::IndexEntry* const chunk = own_or_first("configuration/box");
    if (chunk == nullptr) refuse("configuration/box", "missing", "must be there");
    const auto box = file_.get<float>(*chunk);
    if (box.size() != 6) {
      refuse("configuration/box", fmt::format("{} numbers", box.size()),
             "must be three lengths and three tilts");
    }
    if (!(std::min({box[0], box[1], box[2]}) > 0)) {
      const bool is_flat = box[0] > 0 && box[1] > 0 && box[2] == 0;
      refuse("configuration/box", fmt::format("lengths {}, {} and {}", box[0], box[1], box[2]), "{}",
             is_flat ? "must be > 0: with Lz = 0 the file has two dimensions, spheres have three"
                     : "must be three lengths > 0");
    }
    const double lx = box[0], ly = box[1], lz = box[2];
    snapshot.lattice = {Vector3{lx, 0, 0}, Vector3{box[3] * ly, ly, 0},
                        Vector3{box[4] * lz, box[5] * lz, lz}};
    snapshot.corner = -0.5 * (snapshot.lattice * Vector3{1, 1, 1});
  }

  void read_spheres(Snapshot& snapshot) const {
    snapshot.radius.assign(count_, 0.5);
    const auto diameters = rows<float, 1>("particles/diameter");
    snapshot.has_sizes = !diameters.empty();
    for (std::size_t i = 0; i < diameters.size(); ++i) {
      if (!(diameters[i][0] > 0))
        refuse("particles/diameter", fmt::format("{}", diameters[i][0]), "must be > 0");
      snapshot.radius[i] = 0.5 * double{diameters[i][0]};
    }
    if (const gsd::IndexEntry* const chunk = own_or_first("particles/types")) {
      if (chunk->rows > most_types) {
        refuse("particles/types", fmt::format("{} types", chunk->rows), "must be at most {}", most_types);
      }
      const auto text = file_.get<std::int8_t>(*chunk, chunk->columns);
      const std::string letters(text.begin(), text.end());
      for (std::size_t k = 0; k < chunk->rows; ++k) {
        snapshot.species_names.emplace_back(letters.substr(k * chunk->columns, chunk->columns).c_str());
      }
    }
    if (snapshot.species_names.empty()) snapshot.species_names = {"A"};
    snapshot.species.assign(count_, 0);
    const auto types = rows<std::uint32_t, 1>("particles/typeid");
    for (std::size_t i = 0; i < types.size(); ++i) {
      if (types[i][0] >= snapshot.species_names.size()) {
        refuse("particles/typeid", std::to_string(types[i][0]), "must be below {}, the number of types",
               snapshot.species_names.size());
      }
      snapshot.species[i] = types[i][0];
    }
  }

  // Reads bonds with forces. Bonds of other programs have no forces and are not contacts.
  void read_contacts(Snapshot& snapshot) const {
    const gsd::IndexEntry *const group = own("bonds/group"), *const normal = own("log/bonds/normal_force"),
                                 *const tangential = own("log/bonds/tangential_force");
    if (group == nullptr || normal == nullptr || tangential == nullptr) return;
    if (normal->rows != group->rows || tangential->rows != group->rows) {
      refuse("log/bonds/normal_force", fmt::format("{} rows", normal->rows),
             "must be {}, the rows of bonds/group", group->rows);
    }
    const auto ids = file_.get<std::uint32_t>(*group, 2);
    const auto forces = file_.get<float>(*normal);
    const auto across = file_.get<float>(*tangential);
    snapshot.contacts.emplace();
    for (std::size_t k = 0; k < forces.size(); ++k) {
      const std::uint32_t i = ids[2 * k], j = ids[2 * k + 1];
      snapshot.contacts->push_back({i, j, forces[k], across[k]});
    }
  }

  void read_stress_of_cell(Snapshot& snapshot) const {
    constexpr std::string_view prefix = "log/stress/";
    for (const gsd::IndexEntry& chunk : file_.chunks(frame_)) {
      const std::string& name = file_.names()[chunk.name];
      if (!name.starts_with(prefix)) continue;
      if (chunk.rows != 6) refuse(name, fmt::format("{} rows", chunk.rows), "must be six");
      const auto t = file_.get<double>(chunk);
      snapshot.stress_of_cell[name.substr(prefix.size())] = {t[0], t[1], t[2], t[3], t[4], t[5]};
    }
  }

  const gsd::Reader& file_;
  std::uint64_t frame_;
  std::uint32_t count_ = 0;
};

}  // namespace

Snapshot read_gsd_frame(const gsd::Reader& file, std::uint64_t frame) {
  return FrameReading(file, frame).read();
}

}  // namespace peclet::engine
