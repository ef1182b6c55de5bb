// Computes the pivots of a system of links: the inverse of (D - K) for each particle, with its own 6 x 6
// block D and K of link_kernels.h.
//
// Everything is static: code compiled for one processor must not be linked into the rest of the program.
#pragma once

#include "engine/kernels/link_solver.h"
#include "engine/kernels/symmetric_inverse.h"

namespace peclet::engine {
namespace {

// Before inversion the own block of a row is (a b; -b c) with b v = w x v, and its pivot holds
//   { a_xx a_yy a_zz w_x   c_xx c_yy c_zz w_y }
//   { a_xy a_xz a_yz w_z   c_xy c_xz c_yz 0 }
// and K: { K_xx K_yy K_zz 0   K_xy K_xz K_yz 0 }.

// Computes what eight links add to the own blocks of their first (sign 1) or second (sign -1) particles.
PECLET_ALWAYS_INLINE void block_of_links(const Floats* n, const Floats& squeeze, const Floats& shear,
                                         const Floats& pump, const Floats& twist, float sign, Floats* block) {
  const Floats along = squeeze - shear, p = sign * pump;
  const Floats xy = n[0] * n[1], xz = n[0] * n[2], yz = n[1] * n[2];
  for (int c = 0; c < 3; ++c) {
    block[c] = along * n[c] * n[c] + shear;
    block[4 + c] = twist * (1.0F - n[c] * n[c]);
  }
  const Floats beside[3] = {xy, xz, yz};
  for (int c = 0; c < 3; ++c) {
    block[8 + c] = along * beside[c];
    block[12 + c] = Floats{} - twist * beside[c];
  }
  block[3] = p * n[0];
  block[7] = p * n[1];
  block[11] = p * n[2];
  block[15] = Floats{};
}

// Transposes a matrix of eight rows of eight numbers.
PECLET_ALWAYS_INLINE void transpose(Floats* rows) {
#ifdef __AVX2__
  __m256 pairs[8], quads[8];
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = _mm256_unpacklo_ps(rows[k], rows[k + 1]);
    pairs[k + 1] = _mm256_unpackhi_ps(rows[k], rows[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    quads[k] = _mm256_shuffle_ps(pairs[k], pairs[k + 2], 0x44);
    quads[k + 1] = _mm256_shuffle_ps(pairs[k], pairs[k + 2], 0xee);
    quads[k + 2] = _mm256_shuffle_ps(pairs[k + 1], pairs[k + 3], 0x44);
    quads[k + 3] = _mm256_shuffle_ps(pairs[k + 1], pairs[k + 3], 0xee);
  }
  for (int k = 0; k < 4; ++k) {
    rows[k] = _mm256_permute2f128_ps(quads[k], quads[k + 4], 0x20);
    rows[k + 4] = _mm256_permute2f128_ps(quads[k], quads[k + 4], 0x31);
  }
#else
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < a; ++b) {
      const float kept = rows[a][b];
      rows[a][b] = rows[b][a];
      rows[b][a] = kept;
    }
  }
#endif
}

// Calls add(k, part, row) for what each link k of eight adds to the own block of its particle.
template <class Add>
PECLET_ALWAYS_INLINE void for_each_row_of_blocks(Floats* blocks, Add&& add) {
  for (std::size_t part = 0; part < rows_of_block; ++part) {
    transpose(blocks + 8 * part);
    for (std::size_t k = 0; k < links_per_group; ++k) add(k, part, blocks[8 * part + k]);
  }
}

// Sets the own block of each row to D plus the links' part, without K. Puts aside the parts of other blocks.
PECLET_ALWAYS_INLINE void set_own_blocks(const LinkSystem& system, const LinkBlock& of, Pivot* pivots) {
  const auto add_to = [&](const std::uint32_t* index, Floats* block) PECLET_INLINE_LAMBDA {
    for_each_row_of_blocks(block, [&](std::size_t k, std::size_t part, const Floats& row)
                                      PECLET_INLINE_LAMBDA { pivots[index[k]].rows[part].v += row; });
  };
  const auto add_to_first = [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
    Floats block[16];
    block_of_links(group.normal, group.squeeze, group.shear, group.pump_first, group.twist_first, 1.0F,
                   block);
    add_to(group.first, block);
  };
  const auto block_of_second = [](const LinkGroup& group, Floats* block) PECLET_INLINE_LAMBDA {
    block_of_links(group.normal, group.squeeze, group.shear, group.pump_second, group.twist_second, -1.0F,
                   block);
  };
  for_each_particle(of, [&](std::size_t i) PECLET_INLINE_LAMBDA {
    pivots[system.row[i]] = Pivot{{{diagonal_of(system, i)}, {}, {}, {}}};
  });
  for (std::uint32_t l = of.levels_begin; l < of.levels_end; ++l) {
    const GroupRange inner = inner_groups(system, system.levels[l]),
                     crossing = crossing_groups(system, system.levels[l]);
    for (const LinkGroup* group = inner.begin; group < inner.end; ++group) {
      fetch(group + groups_ahead);
      Floats block[16];
      add_to_first(*group);
      block_of_second(*group, block);
      add_to(group->second, block);
    }
    MotionRow* aside = aside_of(system, system.levels[l], rows_of_block);
    for (const LinkGroup* group = crossing.begin; group < crossing.end; ++group) {
      Floats block[16];
      add_to_first(*group);
      block_of_second(*group, block);
      for_each_row_of_blocks(block, [&](std::size_t k, std::size_t part, const Floats& row)
                                        PECLET_INLINE_LAMBDA { aside[rows_of_block * k + part].v = row; });
      aside += rows_of_block * links_per_group;
    }
  }
}

// Adds to K of the first particles the terms with the pivots of the second ones.
PECLET_ALWAYS_INLINE void add_squeezing(const GroupRange& groups, Pivot* pivots) {
  constexpr float kept = 0.9F;
  MotionRow* const rows = reinterpret_cast<MotionRow*>(pivots);
  const auto places = [](const std::uint32_t* of, std::uint32_t part, std::uint32_t* row) {
    for (int k = 0; k < links_per_group; ++k) row[k] = 4 * of[k] + part;
    return row;
  };
  for (const LinkGroup* group = groups.begin; group < groups.end; ++group) {
    fetch(group + groups_ahead);
    std::uint32_t row[links_per_group];
    const Vector3Of<EightFloats> n = normal_of(*group);
    const Vector3Of<EightFloats> squares = {n.x * n.x, n.y * n.y, n.z * n.z};
    const Vector3Of<EightFloats> products = {n.x * n.y, n.x * n.z, n.y * n.z};
    // n.P^-1 n of the second particle
    const EightFloats compliance =
        dot(squares, gather_motions(rows, places(group->second, 0, row)).velocity) +
        EightFloats(2.0F * dot(products, gather_motions(rows, places(group->second, 1, row)).velocity).v);
    const EightFloats weight = EightFloats(kept * group->squeeze * group->squeeze) * compliance;
    add_motions(rows, places(group->first, 2, row), {weight * squares, weight * products});
  }
}

// Replaces B and K of up to eight rows from `begin` on by (B - K)^-1.
PECLET_ALWAYS_INLINE void invert_pivots(Pivot* begin, std::size_t count) {
  Floats held[3][8], a[entries], inverse[entries];
  // Lanes without a particle repeat the first one.
  for (std::size_t part = 0; part < 3; ++part) {
    for (std::size_t k = 0; k < 8; ++k) held[part][k] = begin[k < count ? k : 0].rows[part].v;
    transpose(held[part]);
  }
  // The elements beside the diagonal of each 3 x 3 part.
  constexpr int beside[3][2] = {{1, 0}, {2, 0}, {2, 1}};
  for (int c = 0; c < 3; ++c) {
    const auto [row, column] = beside[c];
    a[entry(c, c)] = held[0][c] - held[2][c];
    a[entry(row, column)] = held[1][c] - held[2][4 + c];
    a[entry(3 + c, 3 + c)] = held[0][4 + c];
    a[entry(3 + row, 3 + column)] = held[1][4 + c];
    a[entry(3 + c, c)] = Floats{};
  }
  const Floats w[3] = {held[0][3], held[0][7], held[1][3]};
  for (int c = 0; c < 3; ++c) {
    const int next = (c + 1) % 3, last = (c + 2) % 3;
    a[entry(3 + next, c)] = Floats{} - w[last];
    a[entry(3 + c, next)] = w[last];
  }
  invert(a, inverse);
  Floats pivot[4][8];
  for (int c = 0; c < 3; ++c) {
    const auto [row, column] = beside[c];
    const int next = (c + 1) % 3;
    pivot[0][c] = inverse[entry(c, c)];
    pivot[0][4 + c] = inverse[entry(3 + c, 3 + c)];
    pivot[1][c] = inverse[entry(row, column)];
    pivot[1][4 + c] = inverse[entry(3 + row, 3 + column)];
    pivot[2][c] = pivot[2][4 + c] = inverse[entry(3 + c, c)];
    // b_xy, b_yz, b_zx; b_yx, b_zy, b_xz. The triangle holds b^T.
    pivot[3][c] = inverse[entry(3 + next, c)];
    pivot[c][3] = held[2][c];
    pivot[c][7] = held[2][4 + c];
  }
  pivot[3][4] = inverse[entry(3, 1)];
  pivot[3][5] = inverse[entry(4, 2)];
  pivot[3][6] = inverse[entry(5, 0)];
  pivot[3][3] = pivot[3][7] = Floats{};
  for (std::size_t part = 0; part < 4; ++part) {
    transpose(pivot[part]);
    for (std::size_t k = 0; k < count; ++k) begin[k].rows[part].v = pivot[part][k];
  }
}

void factorise(const LinkSystem& system, Pivot* pivots, Team& team) {
  climb(
      system, team,
      [&](const LinkBlock& block, std::size_t)
          PECLET_INLINE_LAMBDA { set_own_blocks(system, block, pivots); },
      [](const LinkLevel&) {},
      [&](const GroupRange& groups) PECLET_INLINE_LAMBDA { add_squeezing(groups, pivots); },
      [&](const LinkLevel& level, std::size_t) PECLET_INLINE_LAMBDA {
        for_each_incoming(system, level, [&](std::uint32_t row, std::uint32_t crossing) PECLET_INLINE_LAMBDA {
          for (std::size_t part = 0; part < rows_of_block; ++part) {
            pivots[row].rows[part].v += system.aside[rows_of_block * crossing + part].v;
          }
        });
        for (std::size_t begin = level.rows_begin; begin < level.rows_end; begin += 8) {
          const std::size_t rest = level.rows_end - begin;
          invert_pivots(pivots + begin, rest < 8 ? rest : 8);
        }
      });
}

}  // namespace
}  // namespace peclet::engine
