// The bodies of the loops that apply, precondition and solve a system of links. Eight links side by side, or
// the eight numbers of one particle.
//
// Everything is static: nothing that is compiled for one processor may be linked into a program that runs on
// another.
#pragma once

#include "engine/kernels/link_kernels.h"

#ifdef __AVX2__
#include <immintrin.h>

#include <cstddef>
#endif

namespace peclet::engine {
namespace {

// One number of each of eight links.
struct FloatVector {
  Floats x, y, z;
};
struct FloatMotions {
  FloatVector velocity, spin;
};

PECLET_ALWAYS_INLINE FloatVector operator+(const FloatVector& a, const FloatVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
PECLET_ALWAYS_INLINE FloatVector operator-(const FloatVector& a, const FloatVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
PECLET_ALWAYS_INLINE FloatVector operator*(const Floats& s, const FloatVector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
PECLET_ALWAYS_INLINE Floats dot(const FloatVector& a, const FloatVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
PECLET_ALWAYS_INLINE FloatVector cross(const FloatVector& a, const FloatVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
PECLET_ALWAYS_INLINE FloatVector across(const FloatVector& a, const FloatVector& n) {
  return a - dot(a, n) * n;
}

#ifdef __AVX2__
// Rows of eight particles become one number of each. In both halves of a row (velocity, spin) four rows are
// transposed; then halves change places.
PECLET_ALWAYS_INLINE FloatMotions gather_motions(const MotionRow* rows, const std::uint32_t* index) {
  __m256 part[2][3];
  for (int q = 0; q < 2; ++q) {
    const std::uint32_t* const four = index + std::ptrdiff_t{4} * q;
    const __m256 a = rows[four[0]].v, b = rows[four[1]].v, c = rows[four[2]].v, d = rows[four[3]].v;
    const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
    part[q][0] = _mm256_shuffle_ps(ab, cd, 0x44);
    part[q][1] = _mm256_shuffle_ps(ab, cd, 0xee);
    part[q][2] = _mm256_shuffle_ps(_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d), 0x44);
  }
  const auto velocity = [&](int c) { return _mm256_permute2f128_ps(part[0][c], part[1][c], 0x20); };
  const auto spin = [&](int c) { return _mm256_permute2f128_ps(part[0][c], part[1][c], 0x31); };
  return {{velocity(0), velocity(1), velocity(2)}, {spin(0), spin(1), spin(2)}};
}

// The other way, added to the rows one after the other.
PECLET_ALWAYS_INLINE void add_motions(MotionRow* rows, const std::uint32_t* index, const FloatMotions& add) {
  const __m256 zero = _mm256_setzero_ps();
  for (int q = 0; q < 2; ++q) {
    const auto half = [&](const Floats& velocity, const Floats& spin) {
      return q == 0 ? _mm256_permute2f128_ps(velocity, spin, 0x20)
                    : _mm256_permute2f128_ps(velocity, spin, 0x31);
    };
    const __m256 x = half(add.velocity.x, add.spin.x), y = half(add.velocity.y, add.spin.y),
                 z = half(add.velocity.z, add.spin.z);
    const __m256 xy = _mm256_unpacklo_ps(x, y), z0 = _mm256_unpacklo_ps(z, zero);
    const __m256 xy_high = _mm256_unpackhi_ps(x, y), z0_high = _mm256_unpackhi_ps(z, zero);
    const std::uint32_t* const four = index + std::ptrdiff_t{4} * q;
    rows[four[0]].v += _mm256_shuffle_ps(xy, z0, 0x44);
    rows[four[1]].v += _mm256_shuffle_ps(xy, z0, 0xee);
    rows[four[2]].v += _mm256_shuffle_ps(xy_high, z0_high, 0x44);
    rows[four[3]].v += _mm256_shuffle_ps(xy_high, z0_high, 0xee);
  }
}
#else
FloatMotions gather_motions(const MotionRow* rows, const std::uint32_t* index) {
  FloatMotions result;
  Floats* const parts[6] = {&result.velocity.x, &result.velocity.y, &result.velocity.z,
                            &result.spin.x,     &result.spin.y,     &result.spin.z};
  for (int k = 0; k < links_per_group; ++k) {
    for (int c = 0; c < 6; ++c) {
      (*parts[c])[k] = rows[index[k]].v[c + c / 3];
    }
  }
  return result;
}

void add_motions(MotionRow* rows, const std::uint32_t* index, const FloatMotions& add) {
  const Floats* const parts[6] = {&add.velocity.x, &add.velocity.y, &add.velocity.z,
                                  &add.spin.x,     &add.spin.y,     &add.spin.z};
  for (int k = 0; k < links_per_group; ++k) {
    for (int c = 0; c < 6; ++c) {
      rows[index[k]].v[c + c / 3] += (*parts[c])[k];
    }
  }
}
#endif

PECLET_ALWAYS_INLINE double sum_of(const Floats& v) {
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    sum += static_cast<double>(v[k]);
  }
  return sum;
}

// Sums of many single-precision numbers: those of some rows are added up before they count as doubles.
constexpr std::size_t rows_per_sum = 128;

// The opposite of the load of each link, see terms/lubrication.h.
void add_links(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (const LinkGroup* group = system.groups; group < system.groups + system.count_of_groups; ++group) {
    const FloatMotions i = gather_motions(vector, group->first), j = gather_motions(vector, group->second);
    const FloatVector n = {group->normal[0], group->normal[1], group->normal[2]};
    const FloatVector u = j.velocity - i.velocity;
    const Floats closing = dot(u, n);
    const FloatVector pumped = group->pump_first * i.spin + group->pump_second * j.spin;
    const FloatVector turned = cross(u, n);
    const FloatVector force =
        (group->squeeze * closing) * n + group->shear * (u - closing * n) + cross(pumped, n);
    const FloatVector twisted_first =
        across(group->twist_first * i.spin + group->twist_cross * j.spin, n) - group->pump_first * turned;
    const FloatVector twisted_second =
        across(group->twist_cross * i.spin + group->twist_second * j.spin, n) - group->pump_second * turned;
    add_motions(product, group->first, {FloatVector{} - force, twisted_first});
    add_motions(product, group->second, {force, twisted_second});
  }
}

void multiply(const LinkSystem& system, const MotionRow* vector, MotionRow* product) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    product[i].v = system.diagonal[system.size_class[i]].v * vector[i].v;
  }
  add_links(system, vector, product);
}

// The place in a row of each of the six components.
constexpr int place_of[6] = {0, 1, 2, 4, 5, 6};

// C r of one particle.
PECLET_ALWAYS_INLINE Floats preconditioned(const MotionRow* columns, const Floats& residual) {
  Floats sum = columns[0].v * residual[0];
  for (int c = 1; c < 6; ++c) {
    sum += columns[c].v * residual[place_of[c]];
  }
  return sum;
}

double squared_norm(const LinkSystem& system, const MotionRow* residual) {
  double total = 0;
  for (std::size_t begin = 0; begin < system.particles; begin += rows_per_sum) {
    const std::size_t end = begin + rows_per_sum < system.particles ? begin + rows_per_sum : system.particles;
    Floats sum{};
    for (std::size_t i = begin; i < end; ++i) {
      sum += residual[i].v * preconditioned(system.inverse_blocks + 6 * i, residual[i].v);
    }
    total += sum_of(sum);
  }
  return total;
}

// The row of a particle in a field of vectors.
PECLET_ALWAYS_INLINE const Row& vector_row(const double* rows, std::size_t i) {
  return reinterpret_cast<const Row*>(rows)[i];
}

PECLET_ALWAYS_INLINE void set_motion(MotionRow& to, const Row& velocity, const Row& spin) {
  typedef float FourFloats __attribute__((vector_size(16)));
  reinterpret_cast<FourFloats*>(&to)[0] = __builtin_convertvector(velocity, FourFloats);
  reinterpret_cast<FourFloats*>(&to)[1] = __builtin_convertvector(spin, FourFloats);
}

void set_residual(const LinkSystem& system, const StepRows& step, MotionRow* residual) {
  for (std::size_t i = 0; i < system.particles; ++i) {
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    Row force = vector_row(step.force, i), torque = vector_row(step.torque, i);
    if (step.noise_force != nullptr) {
      force += vector_row(step.noise_force, i);
      torque += vector_row(step.noise_torque, i);
    }
    const Row slowed = vector_row(step.velocity_before, i) - vector_row(step.velocity, i);
    const Row unspun = vector_row(step.spin_before, i) - vector_row(step.spin, i);
    set_motion(residual[i], inertia.translational * slowed + step.timestep * force,
               inertia.rotational * unspun + step.timestep * torque);
  }
}

SquaredMotion squared_motion(const LinkSystem& system, const StepRows& step, MotionRow* motion,
                             MotionRow* product) {
  const Row spin = {0, 0, step.streaming_spin, 0};
  Row inertial{};
  for (std::size_t i = 0; i < system.particles; ++i) {
    const Row streaming = {step.shear_rate * vector_row(step.position, i)[1], 0, 0, 0};
    const Row u = vector_row(step.velocity, i) - streaming, w = vector_row(step.spin, i) - spin;
    const OneBodyFactors& inertia = step.inertia[system.size_class[i]];
    inertial += inertia.translational * u * u + inertia.rotational * w * w;
    set_motion(motion[i], u, w);
  }
  multiply(system, motion, product);
  double total = 0;
  for (std::size_t begin = 0; begin < system.particles; begin += rows_per_sum) {
    const std::size_t end = begin + rows_per_sum < system.particles ? begin + rows_per_sum : system.particles;
    Floats sum{};
    for (std::size_t i = begin; i < end; ++i) {
      sum += motion[i].v * product[i].v;
    }
    total += sum_of(sum);
  }
  return {total, inertial[0] + inertial[1] + inertial[2]};
}

void add_motion(std::size_t particles, const MotionRow* motion, double* velocity, double* spin) {
  typedef float FourFloats __attribute__((vector_size(16)));
  for (std::size_t i = 0; i < particles; ++i) {
    const FourFloats* const halves = reinterpret_cast<const FourFloats*>(motion + i);
    reinterpret_cast<Row*>(velocity)[i] += __builtin_convertvector(halves[0], Row);
    reinterpret_cast<Row*>(spin)[i] += __builtin_convertvector(halves[1], Row);
  }
}

SolverReport solve(const LinkSystem& system, const SolverRows& rows, double target, int most_iterations) {
  const std::size_t count = system.particles;
  // Calls body(i, sum) for each particle and returns the sum of all lanes.
  const auto summed = [&](auto&& body) {
    double total = 0;
    for (std::size_t begin = 0; begin < count; begin += rows_per_sum) {
      const std::size_t end = begin + rows_per_sum < count ? begin + rows_per_sum : count;
      Floats sum{};
      for (std::size_t i = begin; i < end; ++i) {
        body(i, sum);
      }
      total += sum_of(sum);
    }
    return total;
  };
  MotionRow *const x = rows.solution, *const r = rows.residual, *const p = rows.direction,
                   *const q = rows.product;
  SolverReport report;
  report.squared_residual = summed([&](std::size_t i, Floats& sum) {
    p[i].v = preconditioned(system.inverse_blocks + 6 * i, r[i].v);
    x[i].v = Floats{};
    sum += r[i].v * p[i].v;
  });
  while (report.squared_residual > target && report.iterations < most_iterations) {
    multiply(system, p, q);
    const double curvature = summed([&](std::size_t i, Floats& sum) { sum += p[i].v * q[i].v; });
    const auto alpha = static_cast<float>(report.squared_residual / curvature);
    // The product's rows take the preconditioned residual.
    const double squared = summed([&](std::size_t i, Floats& sum) {
      x[i].v += alpha * p[i].v;
      const Floats rest = r[i].v - alpha * q[i].v;
      r[i].v = rest;
      const Floats z = preconditioned(system.inverse_blocks + 6 * i, rest);
      q[i].v = z;
      sum += rest * z;
    });
    const auto beta = static_cast<float>(squared / report.squared_residual);
    report.squared_residual = squared;
    ++report.iterations;
    for (std::size_t i = 0; i < count; ++i) {
      p[i].v = q[i].v + beta * p[i].v;
    }
  }
  return report;
}

// The lower triangle of a symmetric 6 x 6 matrix, row after row.
constexpr int entry(int row, int column) { return row * (row + 1) / 2 + column; }
constexpr int entries = 21;

// What eight links add to the own blocks of their first (sign 1) or second (sign -1) particles.
PECLET_ALWAYS_INLINE void block_of_links(const FloatVector& n, const Floats& squeeze, const Floats& shear,
                                         const Floats& pump, const Floats& twist, float sign, Floats* block) {
  const Floats along = squeeze - shear, p = sign * pump;
  const Floats zero{};
  block[entry(0, 0)] = along * n.x * n.x + shear;
  block[entry(1, 0)] = along * n.y * n.x;
  block[entry(1, 1)] = along * n.y * n.y + shear;
  block[entry(2, 0)] = along * n.z * n.x;
  block[entry(2, 1)] = along * n.z * n.y;
  block[entry(2, 2)] = along * n.z * n.z + shear;
  block[entry(3, 0)] = zero;
  block[entry(3, 1)] = p * n.z;
  block[entry(3, 2)] = zero - p * n.y;
  block[entry(4, 0)] = zero - p * n.z;
  block[entry(4, 1)] = zero;
  block[entry(4, 2)] = p * n.x;
  block[entry(5, 0)] = p * n.y;
  block[entry(5, 1)] = zero - p * n.x;
  block[entry(5, 2)] = zero;
  block[entry(3, 3)] = twist * (1.0F - n.x * n.x);
  block[entry(4, 3)] = zero - twist * n.y * n.x;
  block[entry(4, 4)] = twist * (1.0F - n.y * n.y);
  block[entry(5, 3)] = zero - twist * n.z * n.x;
  block[entry(5, 4)] = zero - twist * n.z * n.y;
  block[entry(5, 5)] = twist * (1.0F - n.z * n.z);
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
    const FloatVector n = {group->normal[0], group->normal[1], group->normal[2]};
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
