"""Fine mistakes in flows and their stress; see named_mutations.py."""

FLOW = [
    (
        "heavy spheres taken along by an accelerating flow without its own acceleration",
        "engine/integrators/integrator.cpp",
        "const Matrix3 gain = change + time * (gradient * gradient);",
        "const Matrix3 gain = change + 0 * time * (gradient * gradient);",
        "engine_tests:Deformation.IsFollowedByHeavySpheresWhereverTheyAre",
    ),
    (
        "normal differences of extension over shear at equal rates",
        "engine/flow/deformation.cpp",
        "steady_rate_ = std::sqrt(2 * contracted(strain, strain));",
        "steady_rate_ = std::sqrt(contracted(strain, strain));",
        "engine_tests:ImposedFlow.HasTheRateOfItsSteadyPart",
    ),
    (
        "noise of the solvent upon the strain of half its variance",
        "engine/realisation/driver.cpp",
        "std::sqrt(2 * thermal_energy_ * solvent_ / (volume * timestep_))",
        "std::sqrt(thermal_energy_ * solvent_ / (volume * timestep_))",
        "engine_tests:StressControl.GivesTheStrainItsShareOfTheTemperature",
    ),
    (
        "a stress whose deficit is not made up for",
        "engine/realisation/driver.cpp",
        "deficit_ += stress_ - stress;",
        "deficit_ += 0 * (stress_ - stress);",
        "engine_tests:EitherMethod/StressControlled.HoldsItsStress/implicit",
    ),
    (
        "stress of a reversed flow with the sign of the cell",
        "engine/observables/transient.cpp",
        "part.sums[0] += flow_.shear_part(stress);",
        "part.sums[0] += stress.xy;",
        "engine_tests:Transient.IsThatOfTheReversedFlow",
    ),
    (
        "stresslet of bubbles",
        "engine/terms/drag.h",
        "(2.5 * volume_fraction) * solvent",
        "(1.0 * volume_fraction) * solvent",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
]
