#include "engine/kernels/links/link_order.h"

#include <algorithm>

namespace peclet::engine {

std::vector<std::uint16_t> LinkOrder::colours(const std::vector<Pair>& pairs, std::size_t particles) {
  begin_.assign(particles + 1, 0);
  for (const Pair& pair : pairs) {
    ++begin_[std::max(pair.first, pair.second)];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : begin_) {
    sum += begin;
    begin = sum;  // the end, from which each neighbour goes down by one
  }
  earlier_.resize(pairs.size());
  for (const Pair& pair : pairs) {
    earlier_[--begin_[std::max(pair.first, pair.second)]] = std::min(pair.first, pair.second);
  }
  std::vector<std::uint16_t> colour(particles);
  std::vector<std::uint32_t> taken_by;  // of each colour, the particle whose neighbour has it; from 1
  for (std::uint32_t i = 0; i < particles; ++i) {
    for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      taken_by[colour[earlier_[k]]] = i + 1;
    }
    const auto free =
        std::find_if(taken_by.begin(), taken_by.end(), [i](std::uint32_t by) { return by != i + 1; });
    colour[i] = static_cast<std::uint16_t>(free - taken_by.begin());
    if (free == taken_by.end()) taken_by.push_back(0);
  }
  return colour;
}

void LinkOrder::arrange(const NeighbourList& list, std::size_t particles) {
  const std::vector<std::uint16_t> colour = colours(list.pairs(), particles);
  const std::size_t count = 1 + (particles == 0 ? 0 : *std::max_element(colour.begin(), colour.end()));
  levels_.assign(count, {});
  next_.assign(count, 0);
  for (const std::uint16_t level : colour) {
    ++levels_[level].rows_end;
  }
  std::uint32_t rows = 0;
  for (std::size_t l = 0; l < count; ++l) {
    levels_[l].rows_begin = next_[l] = rows;
    rows += levels_[l].rows_end;
    levels_[l].rows_end = rows;
  }
  row_.resize(particles);
  particle_.resize(particles);
  level_.resize(particles);
  for (std::uint32_t i = 0; i < particles; ++i) {
    const std::uint32_t row = next_[colour[i]]++;
    row_[i] = row;
    particle_[row] = i;
    level_[row] = colour[i];
  }
  std::fill(next_.begin(), next_.end(), 0);
  for (const Pair& pair : list.pairs()) {
    ++next_[std::max(colour[pair.first], colour[pair.second])];
  }
  std::uint32_t groups = 0;
  for (std::size_t l = 0; l < count; ++l) {
    levels_[l].groups_begin = groups;
    groups += (next_[l] + links_side_by_side - 1) / links_side_by_side * groups_side_by_side;
  }
  most_groups_ = groups;
}

}  // namespace peclet::engine
