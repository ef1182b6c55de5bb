// The particles' own 6 x 6 blocks of a system of links, and their inverses.
//
// Everything is static: nothing that is compiled for one processor may be linked into a program that runs on
// another.
#pragma once

#include "engine/kernels/links/link_motions.h"

namespace peclet::engine {
namespace {

// The lower triangle of a symmetric 6 x 6 matrix, row after row.
constexpr int entry(int row, int column) { return row * (row + 1) / 2 + column; }
constexpr int entries = 21;

// What eight links add to the own blocks of their first (sign 1) or second (sign -1) particles.
PECLET_ALWAYS_INLINE void block_of_links(const Floats* n, const Floats& squeeze, const Floats& shear,
                                         const Floats& pump, const Floats& twist, float sign, Floats* block) {
  const Floats along = squeeze - shear, p = sign * pump;
  const Floats zero{};
  block[entry(0, 0)] = along * n[0] * n[0] + shear;
  block[entry(1, 0)] = along * n[1] * n[0];
  block[entry(1, 1)] = along * n[1] * n[1] + shear;
  block[entry(2, 0)] = along * n[2] * n[0];
  block[entry(2, 1)] = along * n[2] * n[1];
  block[entry(2, 2)] = along * n[2] * n[2] + shear;
  block[entry(3, 0)] = zero;
  block[entry(3, 1)] = p * n[2];
  block[entry(3, 2)] = zero - p * n[1];
  block[entry(4, 0)] = zero - p * n[2];
  block[entry(4, 1)] = zero;
  block[entry(4, 2)] = p * n[0];
  block[entry(5, 0)] = p * n[1];
  block[entry(5, 1)] = zero - p * n[0];
  block[entry(5, 2)] = zero;
  block[entry(3, 3)] = twist * (1.0F - n[0] * n[0]);
  block[entry(4, 3)] = zero - twist * n[1] * n[0];
  block[entry(4, 4)] = twist * (1.0F - n[1] * n[1]);
  block[entry(5, 3)] = zero - twist * n[2] * n[0];
  block[entry(5, 4)] = zero - twist * n[2] * n[1];
  block[entry(5, 5)] = twist * (1.0F - n[2] * n[2]);
}

// Of eight matrices side by side: A = L D L^T, A^-1 = L^-T D^-1 L^-1.
PECLET_ALWAYS_INLINE void invert(const Floats* a, Floats* inverse) {
  Floats lower[entries], inverse_lower[entries], per_pivot[6];
  for (int row = 0; row < 6; ++row) {
    Floats scaled[6];  // L_rk D_k
    Floats pivot = a[entry(row, row)];
    for (int column = 0; column < row; ++column) {
      Floats sum = a[entry(row, column)];
      for (int k = 0; k < column; ++k) {
        sum -= scaled[k] * lower[entry(column, k)];
      }
      scaled[column] = sum;
      lower[entry(row, column)] = sum * per_pivot[column];
      pivot -= sum * lower[entry(row, column)];
    }
    per_pivot[row] = 1.0F / pivot;
  }
  for (int column = 0; column < 6; ++column) {
    for (int row = column + 1; row < 6; ++row) {
      Floats sum = lower[entry(row, column)];
      for (int k = column + 1; k < row; ++k) {
        sum += lower[entry(row, k)] * inverse_lower[entry(k, column)];
      }
      inverse_lower[entry(row, column)] = Floats{} - sum;
    }
  }
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column) {
      Floats sum = row == column ? per_pivot[row] : inverse_lower[entry(row, column)] * per_pivot[row];
      for (int k = row + 1; k < 6; ++k) {
        sum += inverse_lower[entry(k, row)] * per_pivot[k] * inverse_lower[entry(k, column)];
      }
      inverse[entry(row, column)] = sum;
    }
  }
}

// Eight rows of eight numbers become eight columns.
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

// Adds what eight links give to the triangles of their particles, three rows for each.
PECLET_ALWAYS_INLINE void add_blocks(MotionRow* triangles, const std::uint32_t* index, Floats* blocks) {
  for (std::size_t part = 0; part < 3; ++part) {
    transpose(blocks + 8 * part);
    for (int k = 0; k < links_per_group; ++k) {
      triangles[3 * std::size_t{index[k]} + part].v += blocks[8 * part + static_cast<std::size_t>(k)];
    }
  }
}

void invert_blocks(const LinkSystem& system, MotionRow* triangles, MotionRow* inverse_blocks) {
  const std::size_t count = system.particles;
  for (std::size_t i = 0; i < count; ++i) {
    const Floats& diagonal = system.diagonal[system.size_class[i]].v;
    for (std::size_t part = 0; part < 3; ++part) {
      triangles[3 * i + part].v = Floats{};
    }
    for (int c = 0; c < 6; ++c) {
      const int e = entry(c, c);
      triangles[3 * i + static_cast<std::size_t>(e / 8)].v[e % 8] = diagonal[place_of[c]];
    }
  }
  for (const LinkGroup* group = system.groups; group < system.groups + system.count_of_groups; ++group) {
    const Floats* const n = group->normal;
    Floats first[24]{}, second[24]{};
    block_of_links(n, group->squeeze, group->shear, group->pump_first, group->twist_first, 1.0F, first);
    block_of_links(n, group->squeeze, group->shear, group->pump_second, group->twist_second, -1.0F, second);
    add_blocks(triangles, group->first, first);
    add_blocks(triangles, group->second, second);
  }
  for (std::size_t begin = 0; begin < count; begin += 8) {
    const std::size_t here = count - begin < 8 ? count - begin : 8;
    Floats block[24], inverse[entries];
    for (std::size_t part = 0; part < 3; ++part) {
      for (std::size_t k = 0; k < 8; ++k) {
        // Lanes without a particle repeat the first one.
        block[8 * part + k] = triangles[3 * (begin + (k < here ? k : 0)) + part].v;
      }
      transpose(block + 8 * part);
    }
    invert(block, inverse);
    for (int column = 0; column < 6; ++column) {
      Floats rows[8]{};
      for (int row = 0; row < 6; ++row) {
        rows[place_of[row]] = inverse[row < column ? entry(column, row) : entry(row, column)];
      }
      transpose(rows);
      for (std::size_t k = 0; k < here; ++k) {
        inverse_blocks[6 * (begin + k) + static_cast<std::size_t>(column)].v = rows[k];
      }
    }
  }
}

}  // namespace
}  // namespace peclet::engine
