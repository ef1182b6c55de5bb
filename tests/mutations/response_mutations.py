"""Fine mistakes in linear response; see named_mutations.py."""

DUMBBELL = "engine_tests:EitherMethod/LinearResponseOfADumbbell"

RESPONSE = [
    (
        "partner of linear response with its dissipation not reversed",
        "engine/observables/linear_response.cpp",
        "last_.conservative[c] - other.dissipative[c]",
        "last_.conservative[c] + other.dissipative[c]",
        f"{DUMBBELL}.IsThatOfTheCorrelationToo/implicit",
    ),
    (
        "partner of implicit steps on the wrong side of the step",
        "engine/observables/linear_response.cpp",
        "velocities_are_found_ ? before_ : now",
        "velocities_are_found_ ? now : now",
        f"{DUMBBELL}.IsThatOfTheCorrelationToo/implicit",
    ),
    (
        "random forces missing from the flux of momentum",
        "engine/kernels/pair_pass.h",
        "flux.by_pairs = total_stress(sums);",
        "flux.by_pairs = total_stress(sums) + -1.0 * sums.of(StressTerm::brownian_lubrication);",
        "engine_tests:MomentumFlux.HasConservativeAndDissipativeParts",
    ),
    (
        "stress of random forces at the places where a noisy step begins",
        "engine/integrators/acted_stress.cpp",
        "symmetric_dyad(way, force_at_beginning_[i])",
        "0.0 * symmetric_dyad(way, force_at_beginning_[i])",
        "engine_tests:MomentumFlux.OfImplicitStepsIsWhatParticlesGain",
    ),
    (
        "stress without the correction of the predicted velocities",
        "engine/integrators/acted_stress.cpp",
        "  add_stress(sums_, change);",
        "  add_stress(sums_, PairSums{});",
        "engine_tests:MomentumFlux.OfImplicitStepsIsWhatParticlesGain",
    ),
    (
        "noise of the drag placed in the middle of a noisy step",
        "engine/integrators/noisy_midpoint.cpp",
        "-0.5 * timestep_ * symmetric_dyad(after, noise)",
        "-0.0 * timestep_ * symmetric_dyad(after, noise)",
        "engine_tests:MomentumFlux.OfImplicitStepsIsWhatParticlesGain",
    ),
]
