// The scene and the realisations as a card sees them: plain data and pointers into its memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/kernels/pair_terms.h"

namespace peclet::engine {

// A vector in the memory of a card; the fourth number is unused.
struct alignas(32) CardRow {
  double x, y, z, w;
};
// A velocity and a spin in single precision.
struct alignas(32) CardMotion {
  float velocity[3], spin[3], unused[2];
};

// The pair (first, second, image): `first` has the smaller number, and `second` is shifted by `image` lattice
// vectors.
struct CardPair {
  std::uint32_t first, second;
  std::int8_t image[4];
};

// A neighbour of a row: the other sphere, the image of the pair, and whether the pair is listed.
struct CardNeighbour {
  std::uint32_t other;
  std::int8_t image[4];
};

// An end of a pair in the row of its particle: twice the number of the pair, plus 1 for its second particle.
struct CardEnd {
  std::uint32_t pair_and_side, other;
};

// A link without what only its particles' own blocks need (kernels/link_kernels.h), and the rest.
struct alignas(32) CardLink {
  float normal[3], squeeze, shear, pump_first, pump_second, twist_cross;
};
struct CardTwist {
  float first, second;
};

// The vectors of the solver in a row.
struct CardSolverRow {
  CardMotion residual, product, direction, moved, solution;
};

// The numbers of the inverse of an own block: the lower triangle, row after row.
constexpr int block_entries = 21;

// The forces that a step evaluates (integrators/noisy_midpoint.h); a step without noise has the first one.
enum class CardField : std::uint32_t { whole, at_beginning, ahead, with_noise };
constexpr std::size_t count_of_card_fields = 4;

// A size class.
struct CardSize {
  double radius, mass, inertia;
  double drag, turning_drag;
};

// The parameters of a part of a step, which depend on its division.
constexpr int card_levels = 11;
struct CardLevel {
  double timestep;
  bool inertial;  // noisy_midpoint.h
  double drag_noise;
  PairParameters field[count_of_card_fields];
};

// Each step has 7 stresses of six components, the motion's stress, and the numbers and overlaps of contacts.
constexpr int card_stresses = 6 * static_cast<int>(count_of_stress_terms);
enum CardSum : int {
  card_motion = card_stresses,
  card_contacts = card_motion + 6,
  card_overlaps,
  count_of_card_sums,
};
// A block of the production window.
struct CardBlockSums {
  double sum[count_of_card_sums];  // over steps
  double steps, samples;
  double structural[6], translational, rotational;  // over samples
};
constexpr int card_blocks = 32;

// The numbers and arrays that all realisations of a scene share.
struct CardScene {
  std::uint32_t particles, classes;
  bool lubricated, touching, springs;  // the laws of the scene
  std::uint32_t carried_term;          // the stress that moved forces add to (integrators/acted_stress.h)
  double shell, per_structure;         // structural_shell, and the factor of the structural Brownian stress

  // The flow (rate y, 0, 0) and the cell: edges (x, 0, 0), (start_tilt + strain y, y, 0), (0, 0, z).
  double rate;
  double edge_x, edge_y, edge_z;

  // The list of neighbours (state/neighbour_list.h).
  double skin, skin_of_candidates, smallest_range, largest_range;
  bool is_narrow;  // several images of a sphere may be near

  // The steps.
  double tolerance, longest_way;
  double tightness;  // of the tolerance, over the usual one: at most 1
  int most_divisions;
  double largest_displacement, largest_overlap, smallest_radius;  // of the guard
  std::uint64_t equilibration, total, sampling, comparison;       // [steps]; comparison 0: never

  const std::uint16_t* size_class;  // for each particle
  const CardSize* sizes;
  const CardLevel* levels;
  const PairKind* kinds;
  const double *squared_reach, *squared_candidate_reach;  // for each kind
};

enum class CardStatus : std::uint32_t {
  runs,
  ended,       // the last step ended it, by its guard or at the end of the window
  compares,    // the host is to compare the last step with half steps
  needs_room,  // more pairs than the slot has room for
};

// The parts of a step whose time is measured.
enum class CardPhase : std::uint32_t {
  list,
  assembly,
  blocks,
  forces,
  gathering,
  residual,
  solution,
  stress,
  rest
};
constexpr std::size_t count_of_card_phases = 9;

// The numbers of a realisation that are not arrays.
struct CardProgress {
  std::uint64_t seed;
  CardStatus status;
  bool swapped;    // the buffers of the springs have changed places
  bool is_listed;  // pairs and candidates are those of the listed and the found positions

  // State between steps (state/system.h).
  std::uint64_t step;
  double clock_origin;
  std::uint64_t clock_steps;
  double start_tilt, strain;  // of the cell
  std::int32_t flips;         // of the second lattice vector along the first
  double listed_strain, found_strain;
  double displacement_bound;
  std::uint64_t builds;
  std::uint32_t pairs;

  // The last step.
  double displacement, overlap;
  bool finite, broke_off;
  std::uint32_t division;

  // The production window.
  double window_overlap;
  std::uint64_t iterations, divided_steps, deepest_division;
  double sum_of_residuals, largest_residual;

  std::uint64_t cycles[count_of_card_phases];  // of the card, since the realisation came; 0 if emulated
};

// Room of a slot for a realisation.
struct CardRoom {
  std::uint32_t pairs, neighbours;  // pairs, and candidates of a row
};

// A realisation in its slot.
struct CardRealisation {
  CardProgress* progress;
  CardRoom room;

  CardRow *position, *velocity, *spin;                    // state
  std::int32_t (*image)[4];                               // as ParticleState::image
  CardRow *listed, *found;                                // positions when pairs and candidates were found
  CardRow *velocity_change, *spin_change;                 // of the last step, without noise
  CardRow *begin_position, *begin_velocity, *begin_spin;  // where the part of the step began
  CardRow *force, *torque, *noise_force, *noise_torque;
  CardRow* pair_noise;  // the part of noise_force that pairs have
  CardRow *predicted_velocity, *predicted_spin, *force_ahead;

  std::uint32_t* candidate_count;         // for each row
  std::uint32_t *pair_begin, *end_begin;  // for each row, and the end of the last one
  std::uint32_t* row_count;
  CardNeighbour* candidate;
  std::uint32_t* pair_of;  // pair of each candidate in the row of its first particle, or no_pair
  CardPair* pair;
  std::int32_t (*key)[4];  // images of old pairs between unwrapped positions
  CardEnd *end, *linked_end;
  std::uint32_t* linked_count;  // for each row
  std::uint32_t* order;         // of the rows, from many ends to few
  CardRow *pair_force, *torque_first, *torque_second;
  double *springs, *springs_after;  // component by component: sliding, rolling, 1 if it slides
  CardLink* link;
  CardTwist* twist;

  CardMotion *solution, *residual, *motion;
  CardMotion* scaled;  // near the processor: shared memory
  CardSolverRow* solver_rows;
  float* inverse;  // number by number, of the rows in their order; near the processor if there is room
  CardBlockSums* blocks;
  double *step_sums, *part_sums;  // count_of_card_sums each; the latter near the processor
};

constexpr std::size_t most_card_particles = 4096;
constexpr std::uint32_t no_pair = 0xffffffff;
constexpr std::size_t components_of_card_springs = 7;

}  // namespace peclet::engine
