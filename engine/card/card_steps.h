// Steps of a realisation on a card: the implicit steps of integrators/midpoint.h and
// integrators/noisy_midpoint.h with their divisions.
#pragma once

#include "engine/card/card_forces.h"
#include "engine/card/card_window.h"
#include "engine/integrators/implicit_rules.h"

namespace peclet::engine {

// Bounds of a call: it ends after this many steps, or once this time has passed on the clock of the card.
struct CardBounds {
  std::uint64_t steps, nanoseconds;
  bool has_near_blocks = false;  // there is room near the processor for the inverse own blocks
};

// `terms` are those of the forces; `noisy` chooses the method.
template <Terms terms, bool noisy>
class CardSteps {
 public:
  CardSteps(const CardScene& scene, CardRealisation& own, const CardTeam& team)
      : scene_(scene), own_(own), team_(team), at_(*own.progress) {}

  void run(const CardBounds& bounds) {
    const std::uint64_t deadline = team_.now() + bounds.nanoseconds;
    team_.meet();
    since_ = team_.cycles();
    if (at_.swapped) exchange_springs();
    if (!at_.is_listed && at_.status == CardStatus::runs) {
      if (list_.restore()) {
        swap_springs();
        at_.is_listed = true;
      } else {
        at_.status = CardStatus::needs_room;
      }
    }
    for (std::uint64_t made = 0; at_.status == CardStatus::runs && made < bounds.steps; ++made) {
      step();
      if (bounds.nanoseconds > 0 && team_.is_late(deadline)) break;
    }
    team_.once([&] { *own_.progress = at_; });
  }

 private:
  using Stresses = CardStresses<terms>;
  using Forces = CardForces<terms>;
  static CardVector vector(const CardRow& row) { return Forces::vector(row); }
  static CardRow row(const CardVector& v) { return Forces::row(v); }

  template <class T>
  static void swap(T& a, T& b) {
    const T kept = a;
    a = b;
    b = kept;
  }
  void exchange_springs() {
    team_.once([&] { swap(own_.springs, own_.springs_after); });
  }
  void swap_springs() {
    exchange_springs();
    at_.swapped = !at_.swapped;
  }

  // Counts the time since the last call for this part.
  void spent_on(CardPhase phase) {
    const std::uint64_t now = team_.cycles();
    at_.cycles[static_cast<std::size_t>(phase)] += now - since_;
    since_ = now;
  }

  const CardLevel& level() const { return scene_.levels[level_]; }

  // Returns the time of the clock, which counts in parts of the present size.
  double time() const {
    const std::uint64_t steps = (at_.clock_steps << level_) + (part_ - (std::uint64_t{1} << level_));
    return at_.clock_origin + static_cast<double>(steps) * level().timestep;
  }
  double strain_after(double time) const { return scene_.rate * (this->time() + time); }

  // --- A step ---------------------------------------------------------------------------------------------

  // The report of a part of a step, besides the sums.
  struct Report {
    double displacement = 0, overlap = 0, residual = 0;
    int iterations = 0;
    bool finite = true, broke_off = false;
  };

  // Makes a step, in parts if it must be divided, and adds it to the window.
  void step() {
    level_ = 0;
    part_ = 1;
    at_.displacement = at_.overlap = 0;
    at_.finite = true;
    at_.broke_off = false;
    at_.division = 0;
    step_iterations_ = 0;
    step_residual_ = 0;
    team_.each(count_of_card_sums, [&](std::uint32_t k) { own_.step_sums[k] = 0; });
    while (true) {
      const Outcome outcome = make_part();
      if (outcome == Outcome::no_room) {
        at_.status = CardStatus::needs_room;
        return;
      }
      if (outcome == Outcome::divided) {
        forget_change();
        ++level_;
        part_ *= 2;
        if (at_.division < level_) at_.division = level_;
        continue;
      }
      if (outcome == Outcome::broke) break;
      while (level_ > 0 && part_ % 2 == 1) {
        part_ /= 2;
        --level_;
        forget_change();
      }
      if (level_ == 0) break;
      ++part_;
    }
    ++at_.clock_steps;
    ++at_.step;
    CardWindow<Forces, noisy>(scene_, own_, team_, forces_, list_.cell(at_.strain), at_)
        .take({step_iterations_, step_residual_});
  }

  enum class Outcome { made, divided, broke, no_room };

  Outcome make_part() {
    mark();
    const bool list_is_new = at_.displacement_bound == 0 && at_.listed_strain == at_.strain;
    Report report;
    bool found = find_velocities(report);
    if (!found && !list_is_new) {
      return_to_origin();
      if (!rebuild()) return Outcome::no_room;
      mark();
      report = {};
      found = find_velocities(report);
    }
    report.broke_off = !found;
    report.displacement = displacement();
    if (static_cast<int>(level_) < scene_.most_divisions && is_to_be_divided(report)) {
      return_to_origin();
      return Outcome::divided;
    }
    if (!found) {
      at_.broke_off = true;
      at_.displacement = larger_of(report.displacement, scene_.largest_range);
      return Outcome::broke;
    }
    keep_change();
    if (scene_.springs) swap_springs();
    book(report);
    const double timestep = level().timestep;
    move(timestep);
    if (!report.finite) return Outcome::broke;
    return follow_list(report.displacement, timestep) ? Outcome::made : Outcome::no_room;
  }

  // Adds a part to the sums of its step.
  void book(const Report& report) {
    const double weight = 1.0 / static_cast<double>(std::uint64_t{1} << level_);
    team_.each(count_of_card_sums, [&](std::uint32_t k) { own_.step_sums[k] += weight * own_.part_sums[k]; });
    at_.displacement = at_.displacement < report.displacement || !(report.displacement >= 0)
                           ? report.displacement
                           : at_.displacement;
    at_.overlap = larger_of(at_.overlap, report.overlap);
    at_.finite = report.finite;
    step_iterations_ += report.iterations;
    step_residual_ += weight * report.residual;
  }

  bool is_to_be_divided(const Report& report) const {
    return report.broke_off || !report.finite || !(report.displacement <= scene_.longest_way) ||
           (report.residual > unsolved && static_cast<int>(level_) < divisions_of_unsolved);
  }

  static double larger_of(double a, double b) { return a < b ? b : a; }

  void mark() const {
    team_.each(scene_.particles, [&](std::uint32_t i) {
      own_.begin_position[i] = own_.position[i];
      own_.begin_velocity[i] = own_.velocity[i];
      own_.begin_spin[i] = own_.spin[i];
    });
  }
  void return_to_origin() {
    team_.each(scene_.particles, [&](std::uint32_t i) {
      own_.position[i] = own_.begin_position[i];
      own_.velocity[i] = own_.begin_velocity[i];
      own_.spin[i] = own_.begin_spin[i];
    });
    at_.strain = strain_after(0);
  }

  // Moves the spheres to where the present velocities lead from the origin in this time.
  void move(double time) {
    team_.each(scene_.particles, [&](std::uint32_t i) {
      own_.position[i] = row(vector(own_.begin_position[i]) + CardNumber{time} * vector(own_.velocity[i]));
    });
    at_.strain = strain_after(time);
  }

  // Returns the largest displacement in the part, relative to the flow; NaN if one is not finite.
  double displacement() const {
    const auto found = team_.reduce<1, 1>(scene_.particles, [&](std::uint32_t i, auto& own) {
      CardVector v = vector(own_.velocity[i]);
      v.x -= scene_.rate * own_.begin_position[i].y;
      const double squared = dot(v, v).v;
      own.sum[0] += squared;
      own.largest[0] = larger_of(own.largest[0], squared);
    });
    if (!(found.sum[0] < __builtin_inf())) return __builtin_nan("");
    return level().timestep * __builtin_sqrt(found.largest[0]);
  }

  bool move_half_a_step() {
    const double half = 0.5 * displacement();
    move(0.5 * level().timestep);
    const double allowed = list_.allowed(at_.strain);
    return at_.displacement_bound + half < allowed || list_.largest_displacement(at_.strain) < allowed;
  }

  bool rebuild() {
    spent_on(CardPhase::rest);
    const bool fits = list_.rebuild(at_.strain);
    spent_on(CardPhase::list);
    if (!fits) return false;
    swap_springs();
    at_.displacement_bound = 0;
    return true;
  }

  // Makes a new list if this one does not hold for the next part, now that spheres have moved by `way`.
  bool follow_list(double way, double timestep) {
    at_.displacement_bound += way + timestep * larger_of(scene_.rate, -scene_.rate) * at_.displacement_bound;
    const double allowed = list_.allowed(at_.strain), next = 0.5 * way;
    if (at_.displacement_bound + next < allowed) return true;
    at_.displacement_bound = list_.largest_displacement(at_.strain);
    return at_.displacement_bound + next < allowed || rebuild();
  }

  // --- The velocities of a part ---------------------------------------------------------------------------

  bool find_velocities(Report& report) {
    if constexpr (noisy) {
      return find_with_noise(report);
    } else {
      return find_without_noise(report);
    }
  }

  typename Forces::Moment moment() const {
    return {level(), list_.cell(at_.strain), own_.velocity, own_.spin};
  }

  // Sets the sums of the part to those of its pairs.
  void set_part_sums(const CardTotals& sums, Report& report) const {
    clear_part_sums();
    add_stresses<terms>(sums);
    note_contacts(sums, report);
  }
  void clear_part_sums() const {
    team_.each(count_of_card_sums, [&](std::uint32_t k) { own_.part_sums[k] = 0; });
  }
  template <Terms of>
  void add_stresses(const CardTotals& totals) const {
    team_.each(card_stresses, [&](std::uint32_t k) {
      if (CardStresses<of>::has(k / 6))
        own_.part_sums[k] += totals.sum[CardStresses<of>::place(k / 6) + static_cast<int>(k % 6)];
    });
  }
  void note_contacts(const CardTotals& totals, Report& report) const {
    team_.once([&] {
      own_.part_sums[card_contacts] = totals.sum[Stresses::contacts];
      own_.part_sums[card_overlaps] = totals.sum[Stresses::overlaps];
    });
    report.overlap = totals.largest[0];
    report.finite = totals.sum[Stresses::not_finite] == 0;
  }

  // Sets forces and torques to those of pairs and drag, and own.residual to the residual of the equations.
  struct Residual {
    double own_squared;     // r.B^-1 r
    double squared_motion;  // as VelocitySolver::Residual
  };
  Residual set_residual() {
    spent_on(CardPhase::rest);
    const Residual residual = residual_of_rows_and_links();
    spent_on(CardPhase::residual);
    return residual;
  }
  Residual residual_of_rows_and_links() const {
    const double timestep = level().timestep;
    // Motions relative to the flow, for a while in own.motion.
    const auto of_rows = team_.reduce<3, 0>(scene_.particles, [&](std::uint32_t place, auto& sums) {
      const std::uint32_t i = own_.order[place];
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      const CardVector v = vector(own_.velocity[i]), w = vector(own_.spin[i]);
      const CardVector u = v - flow_at(i), turn = w - flow_spin();
      CardVector force = vector(own_.force[i]), torque = vector(own_.torque[i]);
      if constexpr (noisy) {
        force += vector(own_.noise_force[i]);
        torque += vector(own_.noise_torque[i]);
      }
      const CardVector b =
          CardNumber{size.mass} * (vector(own_.begin_velocity[i]) - v) + CardNumber{timestep} * force;
      const CardVector c =
          CardNumber{size.inertia} * (vector(own_.begin_spin[i]) - w) + CardNumber{timestep} * torque;
      own_.residual[i] = motion(b, c);
      own_.motion[i] = motion(u, turn);
      const double drag_time = drag_share() * timestep;
      const double uu = dot(u, u).v, ww = dot(turn, turn).v;
      sums.sum[0] += CardSolver::product(own_.residual[i], solver_.over_block(place, own_.residual[i]));
      sums.sum[1] += size.mass * uu + size.inertia * ww;
      sums.sum[2] +=
          (size.mass + drag_time * size.drag) * uu + (size.inertia + drag_time * size.turning_drag) * ww;
    });
    const double own_squared = of_rows.sum[0], inertial = of_rows.sum[1], of_spheres = of_rows.sum[2];
    const auto of_links = team_.reduce<1, 0>(at_.pairs, [&](std::uint32_t p, auto& sums) {
      const CardLink& link = own_.link[p];
      if (!(link.squeeze > 0 || link.shear > 0)) return;
      const CardPair& pair = own_.pair[p];
      sums.sum[0] += CardSolver::work(link, own_.twist[p], own_.motion[pair.first], own_.motion[pair.second]);
    });
    const double whole = of_spheres + of_links.sum[0], changed = larger_of(whole - inertial, 0);
    return {own_squared, whole > 0 ? changed * changed / whole : 0};
  }

  double drag_share() const { return level().inertial ? 0.5 : 1; }

  CardVector flow_at(std::uint32_t i) const { return {scene_.rate * own_.position[i].y, 0.0, 0.0}; }
  CardVector flow_spin() const { return {0.0, 0.0, -0.5 * scene_.rate}; }

  static CardMotion motion(const CardVector& v, const CardVector& w) {
    const auto single = [](CardNumber x) { return static_cast<float>(x.v); };
    return {{single(v.x), single(v.y), single(v.z)}, {single(w.x), single(w.y), single(w.z)}, {}};
  }

  // Sets the loads of the spheres to those of their pairs and of the drag.
  void gather() {
    spent_on(CardPhase::rest);
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      const auto pairs = forces_.pairs_of_row(i);
      own_.force[i] = row(pairs.force + CardNumber{size.drag} * (flow_at(i) - vector(own_.velocity[i])));
      own_.torque[i] =
          row(pairs.torque + CardNumber{size.turning_drag} * (flow_spin() - vector(own_.spin[i])));
      if constexpr (noisy) own_.force_ahead[i] = row(pairs.force);
    });
    spent_on(CardPhase::gathering);
  }

  void add_solution() const {
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const CardMotion& x = own_.solution[i];
      CardRow &v = own_.velocity[i], &w = own_.spin[i];
      v.x += static_cast<double>(x.velocity[0]);
      v.y += static_cast<double>(x.velocity[1]);
      v.z += static_cast<double>(x.velocity[2]);
      w.x += static_cast<double>(x.spin[0]);
      w.y += static_cast<double>(x.spin[1]);
      w.z += static_cast<double>(x.spin[2]);
    });
  }

  // Corrects the velocities, unless that is needless.
  CardSolution correct(const CardGoal& goal, Report& report) {
    spent_on(CardPhase::rest);
    const CardSolution found = solver_.solve(goal, most_solver_iterations);
    spent_on(CardPhase::solution);
    report.iterations += found.iterations;
    if (found.finite && !found.needless) add_solution();
    return found;
  }

  // integrators/midpoint.cpp
  bool find_without_noise(Report& report) {
    constexpr NewtonIterations iterations = newton_iterations(terms.friction);
    team_.each(scene_.particles, [&](std::uint32_t i) {
      own_.velocity[i] = row(vector(own_.velocity[i]) + vector(own_.velocity_change[i]));
      own_.spin[i] = row(vector(own_.spin[i]) + vector(own_.spin_change[i]));
    });
    for (int iteration = 0;; ++iteration) {
      if (!move_half_a_step()) return false;
      if (iteration == 0) assemble(CardField::whole);
      set_part_sums(evaluate(CardField::whole), report);
      gather();
      const Residual residual = set_residual();
      if (!(residual.own_squared < __builtin_inf() && residual.squared_motion < __builtin_inf())) {
        report.finite = false;
        return true;
      }
      // Only a solution tells the energy norm of the residual. It begins, and ends early if that is small.
      const double target =
          larger_of(scene_.tolerance * scene_.tolerance * residual.squared_motion, no_motion);
      const double good = iteration < iterations.usual ? target : far_residual * far_residual * target;
      // The system before may tell it as well, if the residual is small at a glance.
      constexpr double at_a_glance = 10;
      const bool is_last = iteration >= iterations.most;
      if (iteration > 0 && (is_last || residual.own_squared < at_a_glance * good)) {
        spent_on(CardPhase::rest);
        const CardSolution seen = solver_.solve(
            {.least = 0.5 * good, .fixed = 0, .relative = 0.1, .enough = good}, most_solver_iterations);
        spent_on(CardPhase::solution);
        report.iterations += seen.iterations;
        if (seen.needless || !seen.finite || is_last) {
          report.residual =
              residual.squared_motion > 0 ? __builtin_sqrt(seen.of_zero / residual.squared_motion) : 0;
          report.finite = report.finite && seen.finite;
          return true;
        }
      }
      if (iteration > 0) assemble(CardField::whole);
      const double left = scene_.tightness * (iteration == 0 ? iterations.first_forcing : iterations.forcing);
      const CardSolution found =
          correct({.least = 0.25 * target, .fixed = 0, .relative = left * left, .enough = good}, report);
      const double motion = residual.squared_motion + (iteration == 0 ? found.of_zero : 0);
      report.residual = motion > 0 ? __builtin_sqrt(found.of_zero / motion) : 0;
      report.finite = report.finite && found.finite;
      if (found.needless || !report.finite) return true;
    }
  }

  void assemble(CardField field) {
    spent_on(CardPhase::rest);
    forces_.assemble(moment(), field);
    spent_on(CardPhase::assembly);
    solver_.prepare(level().timestep, drag_share());
    spent_on(CardPhase::blocks);
  }

  CardTotals evaluate(CardField field) {
    spent_on(CardPhase::rest);
    const CardTotals sums = forces_.evaluate(moment(), field);
    spent_on(CardPhase::forces);
    return sums;
  }

  // Solves the system of the present loads to `factor` times the tolerance.
  bool solve(double factor, Report& report) {
    const Residual residual = set_residual();
    const double squared_tolerance = factor * factor * scene_.tolerance * scene_.tolerance;
    const CardSolution found = correct({.least = 0,
                                        .fixed = squared_tolerance * residual.squared_motion,
                                        .relative = squared_tolerance,
                                        .enough = 0},
                                       report);
    report.residual = relative_residual(scene_.tolerance, found.squared, found.goal);
    return found.finite;
  }

  // integrators/noisy_midpoint.cpp
  bool find_with_noise(Report& report) {
    constexpr Terms noise_terms = Forces::noise_terms;
    const double timestep = level().timestep;
    clear_part_sums();
    bool noise_is_finite = true;
    if (scene_.lubricated) {
      spent_on(CardPhase::rest);
      const auto noise = forces_.evaluate_noise(moment(), part_);
      spent_on(CardPhase::forces);
      add_stresses<noise_terms>(noise);
      noise_is_finite = noise.sum[CardStresses<noise_terms>::not_finite] == 0;
    }
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      typename Forces::RowLoad pairs{};
      if (scene_.lubricated) pairs = forces_.pairs_of_row(i);
      const auto normals = forces_.normals_of_sphere(i, part_);
      const double amplitude = level().drag_noise;
      own_.pair_noise[i] = row(pairs.force);
      own_.noise_force[i] =
          row(pairs.force + CardNumber{amplitude * __builtin_sqrt(size.drag)} * normals.theta);
      own_.noise_torque[i] =
          row(pairs.torque + CardNumber{amplitude * __builtin_sqrt(size.turning_drag)} * normals.chi);
    });
    assemble(CardField::at_beginning);
    evaluate(CardField::at_beginning);
    gather();
    const bool predicted = solve(factor_of_prediction, report);
    if (!move_half_a_step()) return false;

    assemble(CardField::ahead);
    const CardTotals sums = evaluate(CardField::ahead);
    gather();
    add_stresses<terms>(sums);
    note_contacts(sums, report);
    team_.each(scene_.particles, [&](std::uint32_t i) {
      own_.predicted_velocity[i] = own_.velocity[i];
      own_.predicted_spin[i] = own_.spin[i];
      if (!level().inertial) return;
      // Turns the drag on V into that on (V_n + V) / 2.
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      own_.force[i] =
          row(vector(own_.force[i]) +
              CardNumber{0.5 * size.drag} * (vector(own_.velocity[i]) - vector(own_.begin_velocity[i])));
      own_.torque[i] = row(vector(own_.torque[i]) + CardNumber{0.5 * size.turning_drag} *
                                                        (vector(own_.spin[i]) - vector(own_.begin_spin[i])));
    });
    const bool solved = solve(1, report);
    spent_on(CardPhase::rest);
    end_stress(timestep);
    spent_on(CardPhase::stress);

    if (!move_half_a_step()) return false;
    if constexpr (terms.friction) evaluate(CardField::whole);  // advances the springs
    add_motion(timestep);
    report.finite = report.finite && noise_is_finite && predicted && solved;
    return true;
  }

  // ActedStress::end()
  void end_stress(double timestep) {
    typename Forces::Moment before = moment();
    before.velocity = own_.predicted_velocity;
    before.spin = own_.predicted_spin;
    const CardTotals change = forces_.leave_change(before, own_.velocity, own_.spin);
    add_stresses<terms>(change);
    const double half = 0.5 * timestep;
    const auto carried = team_.reduce<6, 0>(scene_.particles, [&](std::uint32_t i, auto& sums) {
      const CardVector v = vector(own_.velocity[i]);
      const CardVector way = CardNumber{half} * (v - flow_at(i));
      const CardVector changed = CardNumber{half} * (v - vector(own_.predicted_velocity[i]));
      const CardVector ahead = vector(own_.force_ahead[i]) + forces_.pairs_of_row(i).force;
      Forces::add(sums.sum, CardNumber{-1.0} * (symmetric_dyad(way, vector(own_.pair_noise[i])) +
                                                symmetric_dyad(changed, ahead)));
    });
    team_.each(6, [&](std::uint32_t c) { own_.part_sums[6 * scene_.carried_term + c] += carried.sum[c]; });
  }

  // NoisyMidpoint::motion()
  void add_motion(double timestep) {
    const auto found = team_.reduce<6, 0>(scene_.particles, [&](std::uint32_t i, auto& sums) {
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      const CardVector flow = flow_at(i);
      const CardVector after = vector(own_.velocity[i]) - flow,
                       before = vector(own_.begin_velocity[i]) - flow,
                       mean = CardNumber{0.5} * (before + after);
      const CardVector noise = vector(own_.noise_force[i]) - vector(own_.pair_noise[i]);
      const double dragged = level().inertial ? size.drag : 0;
      Forces::add(sums.sum, CardNumber{-size.mass} * symmetric_dyad(after, mean) +
                                CardNumber{-0.5 * timestep} * symmetric_dyad(after, noise) +
                                CardNumber{0.5 * timestep * dragged} * symmetric_dyad(before, mean));
    });
    team_.each(6, [&](std::uint32_t c) { own_.part_sums[card_motion + c] = found.sum[c]; });
  }

  // The guess for the next part, without noise.
  void keep_change() const {
    if constexpr (!noisy) {
      team_.each(scene_.particles, [&](std::uint32_t i) {
        own_.velocity_change[i] = row(vector(own_.velocity[i]) - vector(own_.begin_velocity[i]));
        own_.spin_change[i] = row(vector(own_.spin[i]) - vector(own_.begin_spin[i]));
      });
    }
  }
  void forget_change() const {
    if constexpr (!noisy) {
      team_.each(scene_.particles,
                 [&](std::uint32_t i) { own_.velocity_change[i] = own_.spin_change[i] = {}; });
    }
  }

  const CardScene& scene_;
  CardRealisation& own_;
  const CardTeam& team_;
  CardProgress at_;
  CardList list_{scene_, own_, at_, team_};
  Forces forces_{scene_, own_, at_, team_};
  CardSolver solver_{scene_, own_, team_};

  std::uint64_t since_ = 0;
  std::uint32_t level_ = 0;
  std::uint64_t part_ = 1;  // as NoiseKey::part
  int step_iterations_ = 0;
  double step_residual_ = 0;
};

}  // namespace peclet::engine
