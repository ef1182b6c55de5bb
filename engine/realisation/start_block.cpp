#include "engine/realisation/start_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "contract/decimal.h"
#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/json.h"
#include "contract/key_table.h"
#include "contract/sha256.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/placed_spheres.h"
#include "engine/scene/size_distribution.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

// The spheres and the cell of a file, as a scene names them.
struct Found {
  std::map<double, std::size_t> spheres;  // number of each radius
  Vector3 edges;
  double overlap = 0;  // the largest, over the smaller radius

  bool is_alike(const Found& other) const {
    const auto is_alike = [](double one, double two) { return is_near(one, two, two); };
    return spheres == other.spheres && is_alike(edges.x, other.edges.x) && is_alike(edges.y, other.edges.y) &&
           is_alike(edges.z, other.edges.z);
  }
  bool is_cube() const { return is_near(edges.y, edges.x, edges.x); }

  double volume_fraction() const {
    std::vector<double> radius;
    for (const auto& [a, number] : spheres) radius.insert(radius.end(), number, a);
    return with_digits(solid_volume(radius) / (edges.x * edges.y * edges.z), 9);
  }
};

Found found_in(const std::string& file, std::int64_t frame) {
  const SnapshotFile frames(file);
  const Snapshot snapshot = frames.read(frames.index_of(frame));
  if (!snapshot.has_sizes) throw InputError(file, "", "", no_sizes);
  const auto& [a, b, c] = snapshot.lattice.column;
  if (is_turned(snapshot) || !is_near(c.x, 0, a.x) || !is_near(c.y, 0, a.x))
    throw InputError(file, "", "", "must have a cell sheared along x, and has another one");
  if (!is_near(c.z, a.x, a.x)) {
    throw InputError(
        file, "", "",
        fmt::format("must have a cell as long along z as along x, and has {:.6g} and {:.6g}", c.z, a.x));
  }
  Found found{.spheres = {}, .edges = {a.x, b.y, c.z}};
  for (const double radius : snapshot.radius) ++found.spheres[with_digits(radius, 6)];
  if (found.spheres.size() > most_species) {
    throw InputError(
        file, "", "",
        fmt::format("must have at most {} radii, and has {}", most_species, found.spheres.size()));
  }
  ParticleState particles = make_particles(snapshot.radius, 1);
  for (std::size_t i = 0; i < snapshot.count(); ++i) particles.position.set(i, snapshot.position[i]);
  found.overlap = largest_overlap(particles, PeriodicCell(found.edges, {}, b.x));
  return found;
}

std::string list_of(const std::vector<std::string>& files) {
  std::string lines;
  for (const std::string& file : files) {
    lines += fmt::format("{}  {}\n", sha256_of_file(file), fs::absolute(file).lexically_normal().string());
  }
  return lines;
}

// Throws InputError for a file that is there and is no such list, because it would be lost.
void require_list(const std::string& path) {
  if (!fs::exists(path)) return;
  const std::string text = fs::is_regular_file(path) ? read_file(path) : "";
  if (!is_hash(text.substr(0, 64))) {
    throw InputError("--list", "", path,
                     "must be a new file or a list, and is another file, which would be lost");
  }
}

}  // namespace

WrittenKeys start_block(const StartOptions& options) {
  if (options.files.size() > 1 && options.list.empty()) {
    throw InputError("--list", "", "", "is missing: it names the list that is written of several files");
  }
  const Found first = found_in(options.files.front(), options.frame);
  double overlap = first.overlap;
  for (std::size_t k = 1; k < options.files.size(); ++k) {
    const Found own = found_in(options.files[k], options.frame);
    overlap = std::max(overlap, own.overlap);
    if (own.is_alike(first)) continue;
    throw InputError(
        options.files[k], "", "",
        fmt::format("must have the radii and the cell of {}, and has others", options.files.front()));
  }
  const bool is_list = !options.list.empty();
  if (is_list) {
    require_list(options.list);
    write_durably(options.list, list_of(options.files));
  }
  const std::string file = is_list ? options.list : options.files.front();

  Json species = Json::array();
  std::size_t count = 0;
  for (const auto& [radius, number] : first.spheres) {
    species.push_back({{"radius", radius}, {"number_share", number}});
    count += number;
  }
  Json start = {{is_list ? "list" : "file", fs::absolute(file).lexically_normal().string()},
                {"sha256", sha256_of_file(file)}};
  if (options.frame != -1) start["frame"] = options.frame;
  WrittenKeys answer;
  answer.block = fmt::format("\"particles\": {},\n\"volume_fraction\": {},\n",
                             Json{{"count", count}, {"density", 1}, {"species", species}}.dump(),
                             Json(first.volume_fraction()).dump());
  if (!first.is_cube()) answer.block += fmt::format("\"box\": {},\n", Json{{"height", first.edges.y}}.dump());
  answer.block += fmt::format("\"start\": {}\n", start.dump());
  answer.remarks = fmt::format(
      "{} spheres of {} in {}; the largest overlap is {:.2g} of a radius. The density is yours to set.\n",
      count, first.spheres.size() == 1 ? "one radius" : fmt::format("{} radii", first.spheres.size()),
      options.files.size() == 1 ? options.files.front()
                                : fmt::format("each of {} files", options.files.size()),
      overlap);
  if (options.files.size() == 1) {
    answer.remarks +=
        "Without noise all seeds of one file are alike: give a file for each seed, and --list.\n";
  }
  return answer;
}

}  // namespace peclet::engine
