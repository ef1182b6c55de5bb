#include "engine/kernels/pair_kinds.h"

#include <algorithm>

namespace peclet::engine {

PairKind make_pair_kind(const Physics& physics, double first, double second) {
  PairKind kind{};
  kind.radius_first = first;
  kind.radius_second = second;
  kind.sum_of_radii = first + second;
  kind.smaller_radius = std::min(first, second);
  kind.reduced_diameter = 2 * first * second / kind.sum_of_radii;
  if (physics.lubrication) {
    kind.gap = lubricated_gap(*physics.lubrication, kind.sum_of_radii);
    kind.resistance = resistance_constants(physics.viscosity, first, second, physics.lubrication->form);
    kind.roots = root_constants(kind.resistance);
    kind.strain = strain_lengths(first, second);
    kind.lubrication_range = engine::lubrication_range(*physics.lubrication, kind.sum_of_radii);
  }
  kind.range = std::max(kind.sum_of_radii, kind.lubrication_range);
  kind.conservative = of_pair(physics, first, second);
  for_each_conservative_law(
      [&](StressTerm /*part*/, const auto& law) { kind.range = std::max(kind.range, law.range); },
      kind.conservative);
  kind.listed_range = kind.range;
  if (physics.thermal_energy > 0) {
    kind.listed_range = std::max(kind.range, kind.sum_of_radii + structural_shell * std::max(first, second));
  }
  return kind;
}

std::vector<PairKind> make_pair_kinds(const Physics& physics, const std::vector<double>& distinct_radii) {
  std::vector<PairKind> kinds;
  for (const double first : distinct_radii) {
    for (const double second : distinct_radii) kinds.push_back(make_pair_kind(physics, first, second));
  }
  return kinds;
}

RangeTable range_table(const std::vector<PairKind>& kinds, std::size_t classes) {
  RangeTable ranges(classes);
  for (std::size_t a = 0; a < classes; ++a) {
    for (std::size_t b = 0; b < classes; ++b) ranges.at(a, b) = kinds[a * classes + b].listed_range;
  }
  return ranges;
}

}  // namespace peclet::engine
