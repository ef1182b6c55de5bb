"""Fine mistakes in linear response; see named_mutations.py."""

DUMBBELL = "engine_tests:EitherMethod/LinearResponseOfADumbbell"

RESPONSE = [
    (
        "partner of linear response with its dissipation not reversed",
        "engine/responses/linear_response.cpp",
        "last_.conservative[c] - other.dissipative[c]",
        "last_.conservative[c] + other.dissipative[c]",
        f"{DUMBBELL}.IsThatOfTheCorrelationToo/implicit",
    ),
    (
        "partner of implicit steps on the wrong side of the step",
        "engine/responses/linear_response.cpp",
        "velocities_are_found_ ? before_ : now",
        "velocities_are_found_ ? now : now",
        f"{DUMBBELL}.IsThatOfTheCorrelationToo/implicit",
    ),
    (
        "random forces missing from the flux of momentum",
        "engine/kernels/momentum_flux.h",
        "flux.dissipative + sums.of(StressTerm::brownian_lubrication)",
        "flux.dissipative",
        "engine_tests:MomentumFlux.OfVelocityVerletIsTheStressAndTheMotion",
    ),
    (
        "flux of momentum at the places where a noisy step begins",
        "engine/integrators/acted_flux.cpp",
        "flux_by_places(0.5 * timestep, force_at_beginning_",
        "flux_by_places(0.0 * timestep, force_at_beginning_",
        "engine_tests:MomentumFlux.OfImplicitStepsIsWhatParticlesGain",
    ),
    (
        "flux of momentum without the correction of the predicted velocities",
        "engine/integrators/acted_flux.cpp",
        "return velocity[i] - predicted_velocity_[i]",
        "return 0.0 * (velocity[i] - predicted_velocity_[i])",
        "engine_tests:MomentumFlux.OfImplicitStepsIsWhatParticlesGain",
    ),
]
