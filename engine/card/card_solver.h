// Solves the equations of a part of a step on a card, by conjugate gradients with each particle's own block
// as preconditioner B.
//
// An iteration has one sum over all rows (Chronopoulos & Gear 1989, J. Comput. Appl. Math. 25, 153). With u =
// B^-1 r the product is A u = r - sum over links of the load of the other particle: the own block itself is
// not needed. The squared error in the energy norm falls by alpha r.u in each iteration (Hestenes & Stiefel
// 1952, J. Res. Natl. Bur. Stand. 49, 409). What is left is extrapolated from the last decreases.
#pragma once

#include "engine/card/card_state.h"
#include "engine/card/card_team.h"
#include "engine/kernels/symmetric_inverse.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

// A solution is good if its squared error is at most `least`, or `fixed` plus `relative` times that of zero.
// It is not needed if that of zero is at most `enough`.
struct CardGoal {
  double least, fixed, relative, enough;
  double of(double squared) const {
    const double goal = fixed + relative * squared;
    return goal < least ? least : goal;
  }
};

struct CardSolution {
  int iterations = 0;
  double squared = 0;  // estimate of r.A^-1 r at the end
  double of_zero = 0;  // that of the solution 0, the sum of all decreases
  double goal = 0;
  bool needless = false;  // zero is good enough
  bool finite = true;
};

class CardSolver {
 public:
  CardSolver(const CardScene& scene, const CardRealisation& own, const CardTeam& team)
      : scene_(scene), own_(own), team_(team) {}

  // Computes the inverse own blocks, and the ends in each row whose links couple. `drag_share` as in
  // VelocitySolver.
  [[gnu::noinline]] void prepare(double timestep, double drag_share) const {
    const std::uint32_t particles = scene_.particles;
    team_.each(particles, [&](std::uint32_t place) PECLET_INLINE_LAMBDA {
      const std::uint32_t i = own_.order[place];
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      float a[block_entries] = {};
      const double drag_time = drag_share * timestep;
      PECLET_UNROLL
      for (int c = 0; c < 3; ++c) {
        a[entry(c, c)] = static_cast<float>(size.mass + drag_time * size.drag);
        a[entry(3 + c, 3 + c)] = static_cast<float>(size.inertia + drag_time * size.turning_drag);
      }
      const std::uint32_t begin = own_.end_begin[i];
      std::uint32_t count = 0;
      for (std::uint32_t e = begin; e < own_.end_begin[i + 1]; ++e) {
        const CardEnd end = own_.end[e];
        const CardLink& link = own_.link[end.pair_and_side / 2];
        if (!(link.squeeze > 0 || link.shear > 0)) continue;
        add_own(link, own_.twist[end.pair_and_side / 2], end.pair_and_side % 2 != 0, a);
        own_.linked_end[begin + count++] = end;
      }
      own_.linked_count[i] = count;
      float inverse[block_entries];
      invert(a, inverse);
      PECLET_UNROLL
      for (int k = 0; k < block_entries; ++k)
        own_.inverse[static_cast<std::size_t>(k) * particles + place] = inverse[k];
    });
  }

  // Returns B^-1 r of the row at this place of the order.
  CardMotion over_block(std::uint32_t place, const CardMotion& r) const {
    return times(own_.inverse + place, scene_.particles, r);
  }
  PECLET_ALWAYS_INLINE static CardMotion times(const float* inverse, std::uint32_t stride,
                                               const CardMotion& r) {
    float b[block_entries];
    PECLET_UNROLL
    for (int k = 0; k < block_entries; ++k) b[k] = inverse[static_cast<std::size_t>(k) * stride];
    const float v[6] = {r.velocity[0], r.velocity[1], r.velocity[2], r.spin[0], r.spin[1], r.spin[2]};
    float sum[6];
    PECLET_UNROLL
    for (int row = 0; row < 6; ++row) {
      sum[row] = 0;
      PECLET_UNROLL
      for (int column = 0; column < 6; ++column) {
        sum[row] += b[row > column ? entry(row, column) : entry(column, row)] * v[column];
      }
    }
    return {{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5]}, {}};
  }

  static double product(const CardMotion& a, const CardMotion& b) {
    float sum = 0;
    for (int c = 0; c < 3; ++c) sum += a.velocity[c] * b.velocity[c] + a.spin[c] * b.spin[c];
    return static_cast<double>(sum);
  }

  // Solves A solution = residual.
  [[gnu::noinline]] CardSolution solve(const CardGoal& goal, int most_iterations) const {
#ifdef __CUDA__
    if (scene_.particles <= most_own_rows * card_threads) {
      CardOwnRows<CardSolverRow> rows;
      return solve(goal, most_iterations, rows);
    }
#endif
    CardSolverRow* rows = own_.solver_rows;
    return solve(goal, most_iterations, rows);
  }

  // Returns v.load of a link at the motions of its particles.
  static double work(const CardLink& link, const CardTwist& twist, const CardMotion& i, const CardMotion& j) {
    PairGeometryOf<float> pair{};
    pair.normal = {link.normal[0], link.normal[1], link.normal[2]};
    const PairResistanceOf<float> coupling = {link.squeeze,     link.shear,  link.pump_first,
                                              link.pump_second, twist.first, link.twist_cross,
                                              twist.second};
    const Vector3Of<float> u = velocity(j) - velocity(i);
    const PairLoadOf<float> load = lubrication_load(coupling, pair, PairMotionOf<float>{u, spin(i), spin(j)});
    return static_cast<double>(dot(load.force, u) - dot(load.torque_first, spin(i)) -
                               dot(load.torque_second, spin(j)));
  }

  // The arrays that the product reads.
  struct Couplings {
    const std::uint32_t *begin, *count;
    const CardEnd* end;
    const CardLink* link;
    const CardMotion* scaled;
  };

  // Returns A u of a row, where u = B^-1 r.
  PECLET_ALWAYS_INLINE static CardMotion product_of_row(const Couplings& rows, std::uint32_t i,
                                                        const CardMotion& r) {
    Vector3Of<float> force = velocity(r), torque = spin(r);
    const std::uint32_t begin = rows.begin[i], end = begin + rows.count[i];
    for (std::uint32_t e = begin; e < end; ++e) {
      const CardEnd there = rows.end[e];
      const CardLink link = rows.link[there.pair_and_side / 2];
      const bool is_second = there.pair_and_side % 2 != 0;
      // The pair, seen from its second particle, is a pair with the normal -n.
      const float sign = is_second ? -1.0F : 1.0F;
      const Vector3Of<float> n = {sign * link.normal[0], sign * link.normal[1], sign * link.normal[2]};
      const PairResistanceOf<float> coupling = {link.squeeze,
                                                link.shear,
                                                is_second ? link.pump_second : link.pump_first,
                                                is_second ? link.pump_first : link.pump_second,
                                                0,
                                                link.twist_cross,
                                                0};
      const CardMotion u = rows.scaled[there.other];
      const SphereLoadOf<float> load = load_on_first(coupling, n, velocity(u), spin(u));
      force -= load.force;
      torque -= load.torque;
    }
    return {{force.x, force.y, force.z}, {torque.x, torque.y, torque.z}, {}};
  }

 private:
  // `rows` is an array in memory, or of the rows that each member keeps.
  template <class SolverRows>
  PECLET_ALWAYS_INLINE CardSolution solve(const CardGoal& goal, int most_iterations, SolverRows& rows) const {
    CardSolution found;
    const std::uint32_t particles = scene_.particles;
    CardMotion *const solution = own_.solution, *const residual = own_.residual, *const scaled = own_.scaled;
    const float* const inverse = own_.inverse;
    const std::uint32_t* const order = own_.order;
    const Couplings couplings = {own_.end_begin, own_.linked_count, own_.linked_end, own_.link, scaled};
    team_.each_own(particles, rows, [&](std::uint32_t place, CardSolverRow& own) PECLET_INLINE_LAMBDA {
      const std::uint32_t i = order[place];
      own = {};
      own.residual = residual[i];
      scaled[i] = times(inverse + place, particles, own.residual);
    });
    double last_along = 0, last_alpha = 0;
    double decrease[2 * window] = {};
    while (true) {
      const CardTotals sums = team_.template reduce_own<2>(
          particles, rows, [&](std::uint32_t place, CardSolverRow& own, auto& sum) PECLET_INLINE_LAMBDA {
            const std::uint32_t i = order[place];
            const CardMotion u = scaled[i];
            own.product = product_of_row(couplings, i, own.residual);
            sum.sum[0] += product(own.residual, u);
            sum.sum[1] += product(own.product, u);
          });
      const double along = sums.sum[0], curved = sums.sum[1];
      if (!(along < __builtin_inf())) {
        found.finite = false;
        return found;
      }
      if (!(along > 0)) {
        found.needless = found.of_zero <= goal.enough;
        break;
      }
      const double beta = found.iterations == 0 ? 0 : along / last_along;
      const double curvature = curved - (found.iterations == 0 ? 0 : beta * along / last_alpha);
      if (!(curvature > 0)) {  // rounding errors; the residual is what it is
        found.squared = found.squared < along ? along : found.squared;
        break;
      }
      const double alpha = along / curvature;
      last_along = along;
      last_alpha = alpha;
      const auto a = static_cast<float>(alpha), b = static_cast<float>(beta);
      team_.each_own(particles, rows, [&](std::uint32_t place, CardSolverRow& own) PECLET_INLINE_LAMBDA {
        const std::uint32_t i = order[place];
        const CardMotion u = scaled[i];
        PECLET_UNROLL
        for (int c = 0; c < 3; ++c) {
          advance(u.velocity[c], own.product.velocity[c], a, b, own.direction.velocity[c],
                  own.moved.velocity[c], own.solution.velocity[c], own.residual.velocity[c]);
          advance(u.spin[c], own.product.spin[c], a, b, own.direction.spin[c], own.moved.spin[c],
                  own.solution.spin[c], own.residual.spin[c]);
        }
        scaled[i] = times(inverse + place, particles, own.residual);
      });
      ++found.iterations;
      found.of_zero += alpha * along;
      PECLET_UNROLL
      for (int k = 2 * window - 1; k > 0; --k) decrease[k] = decrease[k - 1];
      decrease[0] = alpha * along;
      double now = 0, before = 0;
      PECLET_UNROLL
      for (int k = 0; k < window; ++k) {
        now += decrease[k];
        before += decrease[window + k];
      }
      found.goal = goal.of(found.of_zero);
      found.squared = left(now, before, found.iterations);
      if (found.iterations >= 2 * window && found.of_zero + found.squared <= goal.enough) {
        found.of_zero += found.squared;
        found.needless = true;
        return found;
      }
      if (found.squared <= found.goal || found.iterations >= most_iterations) break;
    }
    team_.each_own(particles, rows, [&](std::uint32_t place, CardSolverRow& own) PECLET_INLINE_LAMBDA {
      solution[order[place]] = own.solution;
    });
    return found;
  }

  // Iterations over which decreases are added up.
  static constexpr int window = 2;

  // Returns what is left after sums of decreases `before` and `now`, as if they went on in proportion.
  static double left(double now, double before, int iterations) {
    constexpr double slowest = 0.97;
    if (iterations < 2 * window) return __builtin_inf();
    const double ratio = now < slowest * before ? now / before : slowest;
    return now * ratio / (1 - ratio);
  }

  PECLET_ALWAYS_INLINE static void advance(float u, float w, float alpha, float beta, float& p, float& s,
                                           float& x, float& r) {
    p = u + beta * p;
    s = w + beta * s;
    x += alpha * p;
    r -= alpha * s;
  }

  static Vector3Of<float> velocity(const CardMotion& m) {
    return {m.velocity[0], m.velocity[1], m.velocity[2]};
  }
  static Vector3Of<float> spin(const CardMotion& m) { return {m.spin[0], m.spin[1], m.spin[2]}; }

  // Adds what a link adds to the own block of its first or second particle.
  PECLET_ALWAYS_INLINE static void add_own(const CardLink& link, const CardTwist& twist, bool is_second,
                                           float* a) {
    const float* const n = link.normal;
    const float along = link.squeeze - link.shear, turn = is_second ? twist.second : twist.first;
    const float pump = is_second ? -link.pump_second : link.pump_first;
    PECLET_UNROLL
    for (int row = 0; row < 3; ++row) {
      PECLET_UNROLL
      for (int column = 0; column < 3; ++column) {
        if (column > row) continue;
        const float dyad = n[row] * n[column];
        a[entry(row, column)] += along * dyad + (row == column ? link.shear : 0.0F);
        a[entry(3 + row, 3 + column)] += turn * ((row == column ? 1.0F : 0.0F) - dyad);
      }
      const int next = (row + 1) % 3, last = (row + 2) % 3;
      a[entry(3 + row, next)] += pump * n[last];
      a[entry(3 + row, last)] -= pump * n[next];
    }
  }

  const CardScene& scene_;
  const CardRealisation& own_;
  const CardTeam& team_;
};

}  // namespace peclet::engine
