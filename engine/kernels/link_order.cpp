#include "engine/kernels/link_order.h"

#include <algorithm>

#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

std::span<const PairRun> runs_of(const NeighbourList& list, const ParticleBlock& block) {
  return std::span(list.runs()).subspan(block.runs_begin, block.runs_end - block.runs_begin);
}

std::span<const Pair> pairs_of(const NeighbourList& list, const ParticleBlock& block) {
  const std::span<const PairRun> runs = runs_of(list, block);
  if (runs.empty()) return {};
  return std::span(list.pairs()).subspan(runs.front().begin, runs.back().end - runs.front().begin);
}

// Calls use(pair, number) for each crossing pair.
template <class Use>
void for_each_crossing(const NeighbourList& list, Use&& use) {
  for (const PairRun& run : list.runs()) {
    for (std::uint32_t p = run.begin; run.crossing != within_block && p < run.end; ++p) {
      use(list.pairs()[p], run.crossing + (p - run.begin));
    }
  }
}

std::uint32_t rounded_up(std::uint32_t links, std::uint32_t unit) { return (links + unit - 1) / unit; }

}  // namespace

void LinkOrder::arrange(const NeighbourList& list, std::size_t particles, int threads) {
  const std::vector<ParticleBlock>& blocks = list.blocks();
  find_boundary(list, particles);
  colour_.resize(particles);
  std::vector<Colour> interior_levels(blocks.size());
  for_each_range(blocks.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      interior_levels[b] = colour(pairs_of(list, blocks[b]), false, blocks[b].begin, blocks[b].end);
    }
  });
  boundary_levels_ =
      list.crossings() == 0 ? 0 : colour(list.pairs(), true, 0, static_cast<std::uint32_t>(particles));
  number_rows(list, interior_levels, threads);
  make_room(list, threads);
  place_crossing_links(list);
}

void LinkOrder::find_boundary(const NeighbourList& list, std::size_t particles) {
  in_boundary_.assign(particles, 0);
  for_each_crossing(list, [&](const Pair& pair, std::uint32_t) {
    in_boundary_[pair.first] = in_boundary_[pair.second] = 1;
  });
}

// Colours the particles of [begin, end) that are in the boundary, or those in the interior: each gets the
// first colour that none of its neighbours there has. Returns the number of colours.
LinkOrder::Colour LinkOrder::colour(std::span<const Pair> pairs, bool boundary, std::uint32_t begin,
                                    std::uint32_t end) {
  const auto among_them = [&](std::uint32_t i) { return (in_boundary_[i] != 0) == boundary; };
  std::vector<std::uint32_t> earlier_begin(end - begin + 1), earlier;
  const auto for_each_pair = [&](auto&& use) {
    for (const Pair& pair : pairs) {
      if (among_them(pair.first) && among_them(pair.second)) {
        use(std::max(pair.first, pair.second) - begin, std::min(pair.first, pair.second));
      }
    }
  };
  for_each_pair([&](std::uint32_t later, std::uint32_t) { ++earlier_begin[later]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : earlier_begin) {
    sum += entry;
    entry = sum;  // the end, which each neighbour lowers by one below
  }
  earlier.resize(sum);
  for_each_pair([&](std::uint32_t later, std::uint32_t i) { earlier[--earlier_begin[later]] = i; });
  std::vector<std::uint32_t> taken_by;  // 1 + the last particle that has a neighbour of this colour
  for (std::uint32_t i = begin; i < end; ++i) {
    if (!among_them(i)) continue;
    for (std::uint32_t k = earlier_begin[i - begin]; k < earlier_begin[i - begin + 1]; ++k) {
      taken_by[colour_[earlier[k]]] = i + 1;
    }
    const auto free = std::ranges::find_if(taken_by, [i](std::uint32_t by) { return by != i + 1; });
    colour_[i] = static_cast<Colour>(free - taken_by.begin());
    if (free == taken_by.end()) taken_by.push_back(0);
  }
  return static_cast<Colour>(taken_by.size());
}

void LinkOrder::number_rows(const NeighbourList& list, const std::vector<Colour>& interior_levels,
                            int threads) {
  blocks_.clear();
  std::uint32_t levels = 0;
  for (std::size_t b = 0; b < interior_levels.size(); ++b) {
    const ParticleBlock& block = list.blocks()[b];
    const std::uint32_t boundary = levels + interior_levels[b];
    blocks_.push_back({block.begin, block.end, levels, boundary, boundary + boundary_levels_});
    levels = boundary + boundary_levels_;
  }
  levels_.assign(levels, {});
  next_.assign(levels, 0);
  row_.resize(colour_.size());
  level_.resize(colour_.size());
  for_each_range(blocks_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) number_rows(blocks_[b]);
  });
}

void LinkOrder::number_rows(const LinkBlock& block) {
  const auto level_of = [&](std::uint32_t i) {
    return colour_[i] + (in_boundary_[i] != 0 ? block.boundary_begin : block.levels_begin);
  };
  for (std::uint32_t i = block.rows_begin; i < block.rows_end; ++i) ++next_[level_of(i)];
  std::uint32_t row = block.rows_begin;
  for (std::uint32_t l = block.levels_begin; l < block.levels_end; ++l) {
    levels_[l].rows_begin = row;
    row += next_[l];
    levels_[l].rows_end = row;
    next_[l] = levels_[l].rows_begin;
  }
  for (std::uint32_t i = block.rows_begin; i < block.rows_end; ++i) {
    const std::uint32_t level = level_of(i), of_particle = next_[level]++;
    row_[i] = of_particle;
    level_[of_particle] = level;
  }
}

// Makes room for one link for each pair within a block.
void LinkOrder::make_room(const NeighbourList& list, int threads) {
  std::ranges::fill(next_, 0);
  for_each_range(blocks_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      for (const PairRun& run : runs_of(list, list.blocks()[b])) {
        if (run.crossing != within_block) continue;
        for (std::uint32_t p = run.begin; p < run.end; ++p) {
          const Pair& pair = list.pairs()[p];
          ++next_[level_[std::max(row_[pair.first], row_[pair.second])]];
        }
      }
    }
  });
  inner_groups_ = 0;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].groups_begin = inner_groups_;
    inner_groups_ += rounded_up(next_[l], links_side_by_side) * groups_side_by_side;
  }
}

void LinkOrder::place_crossing_links(const NeighbourList& list) {
  crossing_.resize(list.crossings());
  incoming_.resize(list.crossings());
  std::vector<std::uint32_t> leaving(levels_.size()), arriving(levels_.size());
  for_each_crossing(list, [&](const Pair& pair, std::uint32_t number) {
    const bool swapped = colour_[pair.first] < colour_[pair.second];
    const std::uint32_t later = row_[swapped ? pair.second : pair.first],
                        earlier = row_[swapped ? pair.first : pair.second];
    crossing_[number] = {leaving[level_[later]]++, later, earlier};
    ++arriving[level_[earlier]];
  });
  std::uint32_t groups = inner_groups_, incoming = 0;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].crossing_begin = groups;
    levels_[l].count_of_crossing = leaving[l];
    groups += rounded_up(leaving[l], links_per_group);
    levels_[l].incoming_begin = levels_[l].incoming_end = incoming;
    incoming += arriving[l];
  }
  crossing_groups_ = groups - inner_groups_;
  for (CrossingLink& link : crossing_) {
    link.place += links_per_group * levels_[level_[link.first]].crossing_begin;
    incoming_[levels_[level_[link.second]].incoming_end++] = {link.second,
                                                              link.place - links_per_group * inner_groups_};
  }
}

}  // namespace peclet::engine
