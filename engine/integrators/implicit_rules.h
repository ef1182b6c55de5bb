// The numbers by which implicit steps end their iterations and are divided. The processor and cards share
// them.
#pragma once

namespace peclet::engine {

// A limit of the iterations of a linear system, far above what any packing has needed.
constexpr int most_solver_iterations = 1000;

// Steps with a larger relative residual are divided.
constexpr double unsolved = 0.1;
// Few divisions are made for this: where forces jump, as at a cut-off, smaller steps have no solution.
constexpr int divisions_of_unsolved = 3;

// Numbers of Newton iterations of a step without noise, and the part of a residual that the solution of a
// linear system may leave in the first and in later ones. The parts are for the default tolerance and shrink
// in proportion to a tighter one: a solution need not be better than the next residual. Contacts open and
// close in the first iteration. Springs that slide enter with their secant stiffness, which converges slowly:
// iterations beyond the usual ones are made only if the residual is above `far_residual` tolerances.
struct NewtonIterations {
  int usual, most;
  double first_forcing, forcing;
};
constexpr NewtonIterations newton_iterations(bool has_springs) {
  return has_springs ? NewtonIterations{3, 8, 0.3, 0.2} : NewtonIterations{6, 6, 0.2, 0.05};
}
constexpr double far_residual = 7;

// Squared residuals below it are rounding errors, as of spheres that follow the flow: the smallest normal
// number in single precision.
constexpr double no_motion = 0x1p-126;

// Returns the relative residual of a linear system that was solved to this tolerance, which allowed the
// squared residual `allowed`. Where few spheres are solved exactly, rounding leaves sums of squares below 0.
inline double relative_residual(double tolerance, double squared, double allowed) {
  return allowed > 0 ? tolerance * __builtin_sqrt((squared < 0 ? 0 : squared) / allowed) : 0;
}

// Factor of the tolerance of the predicted velocities of a step with noise. They matter only by the place to
// which they lead.
constexpr double factor_of_prediction = 5;

}  // namespace peclet::engine
