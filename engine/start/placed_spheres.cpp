#include "engine/start/placed_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <system_error>

#include "contract/input_error.h"
#include "contract/input_file.h"
#include "contract/sha256.h"
#include "engine/scene/start_block.h"
#include "engine/snapshots/snapshot_file.h"
#include "engine/start/packing.h"

namespace peclet::engine {
namespace {

// Of two lengths that a file of single numbers has in common with the scene.
constexpr double rounding = 1e-6;

bool is_near(double a, double b, double scale) { return std::abs(a - b) <= rounding * scale; }

class Placing {
 public:
  Placing(const Scene& scene, std::string file)
      : scene_(scene), start_(*scene.start), file_(std::move(file)) {}

  PlacedSpheres place(std::uint64_t seed) const {
    const std::string path = start_.is_list ? listed(seed) : start_.path;
    if (!start_.is_list) require_hash(path, start_.sha256, "/start/sha256");
    const SnapshotFile frames(path);
    const Snapshot snapshot = frames.read(frames.index_of(start_.frame));
    PlacedSpheres placed;
    placed.system.particles = make_particles(radii_of(snapshot), species_densities(scene_.particles));
    placed.system.box = box_of(snapshot);
    placed.in_motion = !snapshot.velocity.empty() && !snapshot.spin.empty();
    ParticleState& particles = placed.system.particles;
    for (std::size_t i = 0; i < snapshot.count(); ++i) {
      particles.position.set(i, snapshot.position[i]);
      if (!placed.in_motion) continue;
      particles.velocity.set(i, snapshot.velocity[i]);
      particles.angular_velocity.set(i, snapshot.spin[i]);
    }
    return placed;
  }

  // A list needs a line for each seed that may ever be run.
  void require_lines(std::int64_t seeds) const {
    if (!start_.is_list) return;
    require_hash(start_.path, start_.sha256, "/start/sha256");
    const std::string text = read_input(start_.path);
    const std::int64_t lines = std::count(text.begin(), text.end(), '\n') + (text.ends_with('\n') ? 0 : 1);
    if (lines >= seeds) return;
    refuse(
        "/start/list", start_.path,
        fmt::format("must have a line for each of the {} seeds that /realisations/maximum allows; it has {}",
                    seeds, lines));
  }

  // Throws InputError if two lines of the list have one hash.
  void require_different_files() const {
    std::map<std::string, std::uint64_t> seeds;
    std::istringstream lines(read_input(start_.path));
    std::string line;
    for (std::uint64_t seed = 0; std::getline(lines, line); ++seed) {
      const auto [first, is_new] = seeds.emplace(line.substr(0, 64), seed);
      if (is_new || !is_sha256(first->first)) continue;
      refuse(
          "/start/list", line,
          fmt::format("must have another file for each seed without noise, but seed {} begins at a file of "
                      "the same hash as seed {}: both would be one realisation",
                      seed, first->second));
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& pointer, const std::string& value,
                           const std::string& rule) const {
    throw InputError(file_, pointer, value, rule);
  }

  void require_hash(const std::string& path, const std::string& expected, const std::string& pointer) const {
    std::error_code impossible;  // such a name is not there either
    if (!std::filesystem::is_regular_file(path, impossible))
      refuse(start_.pointer(), path, "must be a file that is there");
    const std::string found = sha256_of_file(path);
    if (found != expected) {
      refuse(pointer, expected, fmt::format("must be that of {}, which is now {}", path, found));
    }
  }

  // The file of a line of the list, "HASH  PATH" or "HASH *PATH", which has this hash.
  std::string listed(std::uint64_t seed) const {
    require_hash(start_.path, start_.sha256, "/start/sha256");
    const std::string text = read_input(start_.path);
    std::size_t begin = 0;
    for (std::uint64_t line = 0; line < seed && begin < text.size(); ++line) {
      const std::size_t end = text.find('\n', begin);
      begin = end == std::string::npos ? text.size() : end + 1;
    }
    const std::string line = text.substr(begin, text.find('\n', begin) - begin);
    if (begin >= text.size()) {
      refuse("/start/list", start_.path,
             fmt::format("must have a line for seed {}, the {}th", seed, seed + 1));
    }
    const bool is_good = line.size() > 67 && is_sha256(line.substr(0, 64)) && line[64] == ' ' &&
                         (line[65] == ' ' || line[65] == '*') && line[66] == '/';
    if (!is_good) {
      refuse("/start/list", line, "must be lines of sha256sum, each with an absolute path");
    }
    const std::string path = line.substr(66);
    require_hash(path, line.substr(0, 64), "/start/list");
    return path;
  }

  PeriodicCell box_of(const Snapshot& snapshot) const {
    const Vector3 box = box_lengths(scene_, cube_edge(scene_.particles, scene_.volume_fraction));
    const auto& [a, b, c] = snapshot.lattice.column;
    const bool fits = is_near(a.x, box.x, box.x) && is_near(b.y, box.y, box.y) &&
                      is_near(c.z, box.z, box.z) && is_near(c.x, 0, box.x) && is_near(c.y, 0, box.y);
    if (!fits) {
      refuse(
          scene_.document.contains("addition") ? "/addition" : "/volume_fraction",
          Json(scene_.volume_fraction).dump(),
          fmt::format(
              "makes a box of {:.9g} by {:.9g} by {:.9g}, but the cell of the start has the edges {:.9g}, "
              "{:.9g} and {:.9g} and the tilts {:.9g} and {:.9g} along z: must be that box, sheared along x",
              box.x, box.y, box.z, a.x, b.y, c.z, c.x, c.y));
    }
    return PeriodicCell(box, scene_.physics.flow.deformation().velocity_gradient(0), b.x);
  }

  std::vector<double> radii_of(const Snapshot& snapshot) const {
    const std::vector<double> radius = species_radii(scene_.particles);
    if (snapshot.count() != radius.size()) {
      refuse("/particles/count", std::to_string(radius.size()),
             fmt::format("must be {}, the number of spheres of the start", snapshot.count()));
    }
    for (std::size_t i = 0; i < radius.size(); ++i) {
      if (!is_near(snapshot.radius[i], radius[i], radius[i])) {
        refuse("/particles/species", fmt::format("sphere {} of radius {}", i, radius[i]),
               fmt::format("must be as in the start, where its radius is {}", snapshot.radius[i]));
      }
    }
    return radius;
  }

  const Scene& scene_;
  const Start& start_;
  std::string file_;
};

}  // namespace

PlacedSpheres placed_spheres(const Scene& scene, std::uint64_t seed, const std::string& file) {
  return Placing(scene, file).place(seed);
}

void check_start_of_campaign(const Scene& scene, const std::string& file, std::int64_t seeds) {
  if (!scene.start->is_list && !(scene.physics.thermal_energy > 0)) {
    throw InputError(
        file, "/start/file", scene.start->path,
        "must be a /start/list without noise: every seed of a campaign would be the same realisation");
  }
  const Placing placing(scene, file);
  placing.require_lines(seeds);
  placing.place(0);
  if (scene.start->is_list && !(scene.physics.thermal_energy > 0)) placing.require_different_files();
}

}  // namespace peclet::engine
