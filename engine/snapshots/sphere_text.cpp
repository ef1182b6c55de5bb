#include "engine/snapshots/sphere_text.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace peclet::engine {
namespace {

void name_by_radius(Snapshot& snapshot) {
  std::vector<double> sizes = snapshot.radius;
  std::ranges::sort(sizes);
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  for (const double size : sizes) snapshot.species_names.push_back(fmt::format("a = {}", size));
  for (const double a : snapshot.radius) {
    snapshot.species.push_back(
        static_cast<std::uint32_t>(std::ranges::lower_bound(sizes, a) - sizes.begin()));
  }
}

// Puts species into the order of their names, of numbers by value, so that they are alike in all frames.
void sort_species(Snapshot& snapshot) {
  std::vector<std::string>& names = snapshot.species_names;
  std::vector<std::uint32_t> order(names.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const auto first = number_in<std::int64_t>(names[a]), second = number_in<std::int64_t>(names[b]);
    return first && second ? *first < *second : names[a] < names[b];
  });
  std::vector<std::uint32_t> place(order.size());
  std::vector<std::string> sorted;
  for (const std::uint32_t old : order) {
    place[old] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(names[old]);
  }
  names = std::move(sorted);
  for (std::uint32_t& species : snapshot.species) species = place[species];
}

}  // namespace

Vector3 SphereText::vector(std::string_view& words, const std::string& what) const {
  Vector3 v;
  for (double* const x : {&v.x, &v.y, &v.z}) *x = number<double>(take_word(words), what);
  return v;
}

std::uint32_t SphereText::species(std::string_view name, const std::string& where, Snapshot& snapshot) const {
  if (name.empty()) refuse(where, "must have a species");
  std::vector<std::string>& names = snapshot.species_names;
  const auto known = std::ranges::find(names, name);
  if (known != names.end()) return static_cast<std::uint32_t>(known - names.begin());
  if (names.size() == most_types) refuse("species", "must be at most {}", most_types);
  names.emplace_back(name);
  return static_cast<std::uint32_t>(names.size() - 1);
}

void SphereText::finish(Snapshot& snapshot, const std::vector<std::int64_t>& id) const {
  if (snapshot.count() < 1 || snapshot.count() > most_spheres)
    refuse(fmt::format("{} spheres", snapshot.count()), "must be 1 to {}", most_spheres);
  snapshot.species.empty() ? name_by_radius(snapshot) : sort_species(snapshot);
  if (!id.empty()) {
    std::vector<std::size_t> order(id.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto id_of = [&](std::size_t row) { return id[row]; };
    std::ranges::sort(order, {}, id_of);
    const auto twice = std::ranges::adjacent_find(order, {}, id_of);
    if (twice != order.end()) refuse(fmt::format("id {}", id[*twice]), "must be there once");
    arrange(snapshot, order);
  }
  check_snapshot(snapshot, file_);
}

}  // namespace peclet::engine
