#include "engine/realisation/placed_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <system_error>
#include <vector>

#include "contract/errors.h"
#include "contract/key_table.h"
#include "contract/named_files.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "engine/realisation/packing.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {
namespace {

// Returns the indices of radii in increasing order; those of equal radii stay in order.
std::vector<std::size_t> order_of(const std::vector<double>& radius) {
  std::vector<std::size_t> order(radius.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return radius[i]; });
  return order;
}

class Placing {
 public:
  Placing(const Scene& scene, std::string file)
      : scene_(scene), start_(*scene.start), file_(std::move(file)) {}

  PlacedSpheres place(std::uint64_t seed) const {
    const std::string path = start_.is_list ? listed(seed) : start_.path;
    if (!start_.is_list) require_hash(path, start_.sha256, "/start/sha256");
    const SnapshotFile frames(path);
    Snapshot snapshot = frames.read(frames.index_of(start_.frame));
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

  // Throws InputError if the list has fewer lines than `seeds`.
  void require_lines(std::int64_t seeds) const {
    if (!start_.is_list) return;
    const auto lines = static_cast<std::int64_t>(lines_of_list().size());
    if (lines >= seeds) return;
    refuse("/start/list", start_.path,
           "must have a line for each of the {} seeds that /realisations/maximum allows; it has {}", seeds,
           lines);
  }

  // Throws InputError if two lines of the list have the same hash.
  void require_different_files() const {
    std::map<std::string, std::size_t> seeds;
    const std::vector<std::string> lines = lines_of_list();
    for (std::size_t seed = 0; seed < lines.size(); ++seed) {
      const auto [first, is_new] = seeds.emplace(lines[seed].substr(0, 64), seed);
      if (is_new || !is_hash(first->first)) continue;
      refuse("/start/list", lines[seed],
             "must have another file for each seed without noise, but seed {} begins at a file of "
             "the same hash as seed {}: both would be one realisation",
             seed, first->second);
    }
  }

 private:
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& pointer, const std::string& value,
                           fmt::format_string<Arguments...> rule, Arguments&&... arguments) const {
    throw InputError(file_, pointer, value, fmt::format(rule, std::forward<Arguments>(arguments)...));
  }

  void require_hash(const std::string& path, const std::string& expected, const std::string& pointer) const {
    std::error_code impossible;  // an impossible name counts as absent
    if (!std::filesystem::is_regular_file(path, impossible))
      refuse(start_.pointer(), path, "must be a file that is there");
    const std::string found = sha256_of_file(path);
    if (found != expected) {
      refuse(pointer, expected, "must be that of {}, which is now {}", path, found);
    }
  }

  // Returns the lines of the list without blank ones at its end. Throws InputError if its hash differs.
  std::vector<std::string> lines_of_list() const {
    require_hash(start_.path, start_.sha256, "/start/sha256");
    const std::string text = read_input(start_.path);
    std::string_view rest = without_byte_order_mark(text);
    std::vector<std::string> lines;
    while (!is_blank(rest)) lines.emplace_back(take_line(rest));
    return lines;
  }

  // Returns the path in the seed's line, "HASH  PATH" or "HASH *PATH". Throws InputError if the hash differs.
  std::string listed(std::uint64_t seed) const {
    const std::vector<std::string> lines = lines_of_list();
    if (seed >= lines.size()) {
      refuse("/start/list", start_.path, "must have a line for seed {}, line {}", seed, seed + 1);
    }
    const std::string& line = lines[seed];
    const bool is_good = line.size() > 67 && is_hash(line.substr(0, 64)) && line[64] == ' ' &&
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
    const std::string pointer = scene_.document.contains("addition") ? "/addition" : "/volume_fraction";
    const std::string fraction = Json(scene_.volume_fraction).dump();
    const auto is_zero = [&](double x) { return is_near(x, 0, box.x); };
    if (!(is_zero(a.y) && is_zero(a.z) && is_zero(b.z) && is_zero(c.x) && is_zero(c.y))) {
      refuse(pointer, fraction,
             "must be of a box sheared along x, and the start has a cell with the edges ({:.6g}, "
             "{:.6g}, {:.6g}), ({:.6g}, {:.6g}, {:.6g}) and ({:.6g}, {:.6g}, {:.6g})",
             a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z);
    }
    if (!is_near(a.x, box.x, box.x) || !is_near(b.y, box.y, box.y) || !is_near(c.z, box.z, box.z)) {
      const double solid = solid_volume(species_radii(scene_.particles));
      refuse(pointer, fraction,
             "makes a box of {:.9g} by {:.9g} by {:.9g}, and the cell of the start is {:.9g} by "
             "{:.9g} by {:.9g}: must be as long within {:g} of each; in that cell the volume "
             "fraction is {:.8g}",
             box.x, box.y, box.z, a.x, b.y, c.z, rounding_of_files, solid / (a.x * b.y * c.z));
    }
    return PeriodicCell(box, scene_.physics.flow.deformation().velocity_gradient(0), b.x);
  }

  // Returns the radii of the scene, and brings the spheres of the snapshot into its order.
  std::vector<double> radii_of(Snapshot& snapshot) const {
    const std::vector<double> radius = species_radii(scene_.particles);
    if (snapshot.count() != radius.size()) {
      refuse("/particles/count", std::to_string(radius.size()),
             "must be {}, the number of spheres of the start", snapshot.count());
    }
    if (!snapshot.has_sizes) {
      refuse(start_.pointer(), start_.path, no_sizes);
    }
    // Spheres of the scene are ordered by species. Those of a file that are not are brought into that order.
    const auto are_alike = [](const std::vector<double>& found, const std::vector<double>& wanted) {
      return std::ranges::equal(found, wanted, [](double a, double b) { return is_near(a, b, b); });
    };
    if (!are_alike(snapshot.radius, radius)) {
      const std::vector<std::size_t> wanted = order_of(radius), found = order_of(snapshot.radius);
      std::vector<std::size_t> order(radius.size());
      for (std::size_t k = 0; k < order.size(); ++k) order[wanted[k]] = found[k];
      arrange(snapshot, order);
    }
    if (!are_alike(snapshot.radius, radius)) {
      std::vector<double> wanted = radius, found = snapshot.radius;
      std::ranges::sort(wanted);
      std::ranges::sort(found);
      std::size_t k = 0;  // the first place where they differ
      while (is_near(found[k], wanted[k], wanted[k])) ++k;
      const double a = std::min(wanted[k], found[k]);
      const auto count = [a](const std::vector<double>& radii) {
        return std::ranges::count_if(radii, [a](double one) { return is_near(one, a, a); });
      };
      refuse("/particles/species", fmt::format("{} spheres of radius {:.8g}", count(wanted), a),
             "must be as in the start, which has {}", count(found));
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
  const System first = placing.place(0).system;
  if (scene.physics.contact) {
    const double overlap = largest_overlap(first.particles, first.box), most = scene.guard.largest_overlap;
    if (overlap > most) {
      throw InputError(
          file, scene.start->pointer(), scene.start->path,
          fmt::format("must have spheres that overlap by at most {} radii, the largest_overlap of /guard; "
                      "in that of seed 0 two overlap by {:.3g}",
                      most, overlap));
    }
  }
  if (scene.start->is_list && !(scene.physics.thermal_energy > 0)) placing.require_different_files();
}

}  // namespace peclet::engine
