// The pivots of a system of links: the particles' own 6 x 6 blocks less K, and their inverses
// (link_kernels.h).
//
// Everything is static: nothing that is compiled for one processor may be linked into a program that runs on
// another.
#pragma once

#include "engine/kernels/links/link_solver.h"

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

// D and what links add, of the own block of each row.
PECLET_ALWAYS_INLINE void set_own_blocks(const LinkSystem& system, MotionRow* triangles) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    const Floats& diagonal = diagonal_of(system, i);
    for (std::size_t part = 0; part < 3; ++part) {
      triangles[3 * i + part].v = Floats{};
    }
    for (int c = 0; c < 6; ++c) {
      const int e = entry(c, c);
      triangles[3 * i + static_cast<std::size_t>(e / 8)].v[e % 8] = diagonal[place_of[c]];
    }
  }
  for (std::size_t l = 0; l < system.count_of_levels; ++l) {
    for_each_group(system, system.levels[l], [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
      Floats first[24]{}, second[24]{};
      block_of_links(group.normal, group.squeeze, group.shear, group.pump_first, group.twist_first, 1.0F,
                     first);
      block_of_links(group.normal, group.squeeze, group.shear, group.pump_second, group.twist_second, -1.0F,
                     second);
      add_blocks(triangles, group.first, first);
      add_blocks(triangles, group.second, second);
    });
  }
}

// K of a level's rows, from the pivots of earlier ones.
PECLET_ALWAYS_INLINE void set_squeezing(const LinkSystem& system, const LinkLevel& level,
                                        const MotionRow* inverse_pivots, SqueezingRow* squeezing) {
  constexpr float kept = 0.9F;
  for (std::size_t i = level.rows_begin; i < level.rows_end; ++i) {
    squeezing[i] = {};
  }
  for_each_group(system, level, [&](const LinkGroup& group) PECLET_INLINE_LAMBDA {
    const Vector3Of<EightFloats> n = normal_of(group);
    const EightFloats components[3] = {n.x, n.y, n.z};
    EightFloats compliance{};  // n.P^-1 n of the second particle
    for (std::uint32_t c = 0; c < 3; ++c) {
      std::uint32_t column[links_per_group];
      for (int k = 0; k < links_per_group; ++k) {
        column[k] = 6 * group.second[k] + c;
      }
      compliance = compliance + components[c] * dot(gather_motions(inverse_pivots, column).velocity, n);
    }
    const EightFloats weight = EightFloats(kept * group.squeeze * group.squeeze) * compliance;
    std::uint32_t row[links_per_group];
    for (int k = 0; k < links_per_group; ++k) {
      row[k] = 2 * group.first[k];
    }
    MotionRow* const rows = reinterpret_cast<MotionRow*>(squeezing);
    add_motions(rows, row, {(weight * n.x) * n, (weight * n.y) * n});
    for (std::uint32_t& k : row) {
      ++k;
    }
    add_motions(rows, row, {(weight * n.z) * n, {}});
  });
}

// (B - K)^-1 of up to eight rows from `begin` on.
PECLET_ALWAYS_INLINE void invert_pivots(const MotionRow* triangles, const SqueezingRow* squeezing,
                                        std::size_t begin, std::size_t count, MotionRow* inverse_pivots) {
  Floats block[24], columns[16], inverse[entries];
  // Lanes without a particle repeat the first one.
  const auto row = [&](std::size_t k) { return begin + (k < count ? k : 0); };
  for (std::size_t part = 0; part < 3; ++part) {
    for (std::size_t k = 0; k < 8; ++k) {
      block[8 * part + k] = triangles[3 * row(k) + part].v;
    }
    transpose(block + 8 * part);
  }
  for (std::size_t part = 0; part < 2; ++part) {
    for (std::size_t k = 0; k < 8; ++k) {
      columns[8 * part + k] = squeezing[row(k)].columns[part];
    }
    transpose(columns + 8 * part);
  }
  for (int column = 0; column < 3; ++column) {
    for (int of = column; of < 3; ++of) {
      block[entry(of, column)] -= columns[4 * column + of];
    }
  }
  invert(block, inverse);
  for (int column = 0; column < 6; ++column) {
    Floats rows[8]{};
    for (int of = 0; of < 6; ++of) {
      rows[place_of[of]] = inverse[of < column ? entry(column, of) : entry(of, column)];
    }
    transpose(rows);
    for (std::size_t k = 0; k < count; ++k) {
      inverse_pivots[6 * (begin + k) + static_cast<std::size_t>(column)].v = rows[k];
    }
  }
}

void factorise(const LinkSystem& system, MotionRow* scratch, MotionRow* inverse_pivots,
               SqueezingRow* squeezing) {
  set_own_blocks(system, scratch);
  for (std::size_t l = 0; l < system.count_of_levels; ++l) {
    const LinkLevel& level = system.levels[l];
    set_squeezing(system, level, inverse_pivots, squeezing);
    for (std::size_t begin = level.rows_begin; begin < level.rows_end; begin += 8) {
      const std::size_t rest = level.rows_end - begin;
      invert_pivots(scratch, squeezing, begin, rest < 8 ? rest : 8, inverse_pivots);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
