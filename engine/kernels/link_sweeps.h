// Sweeps over the levels of a system of links, eight links side by side.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/kernels/link_motions.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {
namespace {

PECLET_ALWAYS_INLINE double sum_of(const Floats& v) {
  double sum = 0;
  for (int k = 0; k < 8; ++k) sum += static_cast<double>(v[k]);
  return sum;
}

// The number of rows that are added up in single precision, before their sum counts as a double.
constexpr std::size_t rows_per_sum = 128;

// Calls body(i, sum) for each i of [begin, end), and returns the sum of all lanes. Four sums run side by
// side, so that they do not wait for each other.
template <class Body>
PECLET_ALWAYS_INLINE double summed(std::size_t begin, std::size_t end, Body&& body) {
  double total = 0;
  for (std::size_t part = begin; part < end; part += rows_per_sum) {
    const std::size_t part_end = part + rows_per_sum < end ? part + rows_per_sum : end;
    Floats sum[4]{};
    std::size_t i = part;
    for (; i + 4 <= part_end; i += 4) {
      for (std::size_t k = 0; k < 4; ++k) body(i + k, sum[k]);
    }
    for (; i < part_end; ++i) body(i, sum[0]);
    total += sum_of((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }
  return total;
}

PECLET_ALWAYS_INLINE PairResistanceOf<EightFloats> coupling_of(const LinkGroup& group) {
  return {
      .squeeze = group.squeeze,
      .shear = group.shear,
      .pump_first = group.pump_first,
      .pump_second = group.pump_second,
      .twist_first = group.twist_first,
      .twist_cross = group.twist_cross,
      .twist_second = group.twist_second,
  };
}

PECLET_ALWAYS_INLINE Vector3Of<EightFloats> normal_of(const LinkGroup& group) {
  return {group.normal[0], group.normal[1], group.normal[2]};
}

// Distances of prefetching, for loops over more than a cache holds. Prefetching beyond the end is harmless.
constexpr int groups_ahead = 12, rows_ahead = 48;

template <class T>
PECLET_ALWAYS_INLINE void fetch(const T* place) {
  for (std::size_t byte = 0; byte < sizeof(T); byte += 64) {
    __builtin_prefetch(reinterpret_cast<const char*>(place) + byte);
  }
}

struct GroupRange {
  const LinkGroup *begin, *end;
};

PECLET_ALWAYS_INLINE GroupRange inner_groups(const LinkSystem& system, const LinkLevel& level) {
  const LinkGroup* const begin = system.groups + level.groups_begin;
  return {begin, begin + level.count_of_groups};
}

PECLET_ALWAYS_INLINE GroupRange crossing_groups(const LinkSystem& system, const LinkLevel& level) {
  const LinkGroup* const begin = system.groups + level.crossing_begin;
  return {begin, begin + (level.count_of_crossing + links_per_group - 1) / links_per_group};
}

// Calls body(block, number) for this member's blocks.
template <class Body>
PECLET_ALWAYS_INLINE void for_my_blocks(const LinkSystem& system, const Team& team, Body&& body) {
  const Team::Part mine = team.part_of(system.count_of_blocks);
  for (std::size_t b = mine.begin; b < mine.end; ++b) body(system.blocks[b], b);
}

// Returns the sum over all blocks, in their order, once all members have contributed theirs.
PECLET_ALWAYS_INLINE double total(const LinkSystem& system, Team& team, double LinkSums::*sum) {
  team.meet();
  double total = 0;
  for (std::size_t b = 0; b < system.count_of_blocks; ++b) total += system.sums[b].*sum;
  return total;
}

// Calls body(row) for the rows of a block or level.
template <class Rows, class Body>
PECLET_ALWAYS_INLINE void for_each_row(const Rows& of, Body&& body) {
  for (std::size_t i = of.rows_begin; i < of.rows_end; ++i) body(i);
}

// Calls body(groups) for all groups of levels [begin, end).
template <class Body>
PECLET_ALWAYS_INLINE void for_each_level(const LinkSystem& system, std::uint32_t begin, std::uint32_t end,
                                         Body&& body) {
  for (std::uint32_t l = begin; l < end; ++l) {
    body(inner_groups(system, system.levels[l]));
    body(crossing_groups(system, system.levels[l]));
  }
}

// Adds -L vector to `loads`: the action of earlier rows on later ones.
PECLET_ALWAYS_INLINE void pull(const GroupRange& groups, const MotionRow* vector, MotionRow* loads) {
  for (const LinkGroup* group = groups.begin; group < groups.end; ++group) {
    fetch(group + groups_ahead);
    const FloatMotions j = gather_motions(vector, group->second);
    const auto load = load_on_first(coupling_of(*group), normal_of(*group), j.velocity, j.spin);
    add_motions(loads, group->first, {load.force, load.torque});
  }
}

// Returns -L^T vector of eight links: the action of later rows on earlier ones.
PECLET_ALWAYS_INLINE FloatMotions pushed(const LinkGroup& group, const MotionRow* vector) {
  const FloatMotions i = gather_motions(vector, group.first);
  const auto load = load_on_second(coupling_of(group), normal_of(group), i.velocity, i.spin);
  return {load.force, load.torque};
}

PECLET_ALWAYS_INLINE void push(const LinkSystem& system, const LinkLevel& level, const MotionRow* vector,
                               MotionRow* loads) {
  const GroupRange groups = inner_groups(system, level);
  for (const LinkGroup* group = groups.begin; group < groups.end; ++group) {
    fetch(group + groups_ahead);
    add_motions(loads, group->second, pushed(*group, vector));
  }
}

// Returns where the loads of the crossing links of a level are put aside, with `rows` rows for each link.
PECLET_ALWAYS_INLINE MotionRow* aside_of(const LinkSystem& system, const LinkLevel& level, std::size_t rows) {
  return system.aside + rows * links_per_group * (level.crossing_begin - system.crossing_begin);
}

constexpr std::uint32_t in_order[links_per_group] = {0, 1, 2, 3, 4, 5, 6, 7};

// Puts aside -L^T vector of the links to other blocks.
PECLET_ALWAYS_INLINE void push_aside(const LinkSystem& system, const LinkLevel& level,
                                     const MotionRow* vector) {
  const GroupRange groups = crossing_groups(system, level);
  MotionRow* aside = aside_of(system, level, 1);
  for (const LinkGroup* group = groups.begin; group < groups.end; ++group, aside += links_per_group) {
    for (int k = 0; k < links_per_group; ++k) {
      aside[k].v = Floats{};
    }
    add_motions(aside, in_order, pushed(*group, vector));
  }
}

// Calls take(row, number of the crossing link) for each link of another block to a row of this level.
template <class Take>
PECLET_ALWAYS_INLINE void for_each_incoming(const LinkSystem& system, const LinkLevel& level, Take&& take) {
  for (std::uint32_t k = level.incoming_begin; k < level.incoming_end; ++k) {
    take(system.incoming[k].row, system.incoming[k].crossing);
  }
}

// Walks the levels from first to last: the interior of each block after enter(block, number), then the
// boundary. Calls for each level prepare(level), then add(groups) for the groups of links to earlier rows,
// then finish(level, number of the block). Members do not wait for each other at the end.
template <class Enter, class Prepare, class Add, class Finish>
PECLET_ALWAYS_INLINE void climb(const LinkSystem& system, Team& team, Enter&& enter, Prepare&& prepare,
                                Add&& add, Finish&& finish) {
  for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
    enter(block, b);
    for (std::uint32_t l = block.levels_begin; l < block.boundary_begin; ++l) {
      prepare(system.levels[l]);
      add(inner_groups(system, system.levels[l]));
      finish(system.levels[l], b);
    }
  });
  team.arrive();
  for (std::uint32_t l = 0; l < system.boundary_levels; ++l) {
    for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t) PECLET_INLINE_LAMBDA {
      const LinkLevel& level = system.levels[block.boundary_begin + l];
      prepare(level);
      add(inner_groups(system, level));
    });
    team.wait();
    for_my_blocks(system, team, [&](const LinkBlock& block, std::size_t b) PECLET_INLINE_LAMBDA {
      const LinkLevel& level = system.levels[block.boundary_begin + l];
      add(crossing_groups(system, level));
      finish(level, b);
    });
    team.arrive();
  }
}

}  // namespace
}  // namespace peclet::engine
