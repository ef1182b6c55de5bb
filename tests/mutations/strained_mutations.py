"""Fine mistakes in lubrication by strain rates; see named_mutations.py."""

STRAINED = [
    (
        "rates of strain of both spheres that slide alike",
        "engine/terms/strained_lubrication.h",
        ".shear_first = sliding(i, b),",
        ".shear_first = i + j - sliding(j, c) + 0.1 * (i - j),",
        "engine_tests:StrainedLubrication.LengthsAreThePublishedRatios",
    ),
    (
        "rates of strain that turn spheres twice as much, as printed",
        "engine/terms/strained_lubrication.h",
        ".turn_first = {own(i, b), other(j, b)},",
        ".turn_first = {2 * own(i, b), 2 * other(j, b)},",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
    (
        "rates of strain of the other sphere",
        "engine/kernels/pair_kernel.h",
        "const auto strain = [&](const std::uint32_t* index) PECLET_INLINE_LAMBDA {",
        "const auto strain = [&](const std::uint32_t* index) PECLET_INLINE_LAMBDA {\n    index = first;",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
    (
        "lubrication relative to the flow without its rate of strain",
        "engine/terms/strained_lubrication.h",
        "pair.surface_distance() * strained(flow.strain, n)",
        "pair.distance * strained(flow.strain, n)",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
    (
        "regularisation that moves no gap",
        "engine/terms/pair_resistance.h",
        ".shift = is_mari ? inner : 0",
        ".shift = 0",
        "engine_tests:StrainedLubrication.EqualSpheresHaveThePublishedCoefficients",
    ),
    (
        "way of a step without the regularisation",
        "engine/terms/step_resistance.h",
        "pair.surface_distance() - 0.5 * way) + range.shift",
        "pair.surface_distance() - 0.5 * way)",
        "engine_tests:StepResistance.OnTheWayIsTheAverageOverItsGaps",
    ),
    (
        "levers of lubrication relative to the flow",
        "engine/terms/pair_resistance.h",
        ".lever_at_distance_0 = is_mari ? 1.0 : 0.0",
        ".lever_at_distance_0 = is_mari ? 1.02 : 0.0",
        "engine_tests:StrainedLubrication.EqualSpheresHaveThePublishedCoefficients",
    ),
    (
        "logarithm in the squeezing of lubrication relative to the flow",
        "engine/terms/pair_resistance.h",
        "form == LubricationParameters::Form::mari ? 0 :",
        "form == LubricationParameters::Form::mari && b < 0 ? 0 :",
        "engine_tests:StrainedLubrication.EqualSpheresHaveThePublishedCoefficients",
    ),
    (
        "waves that threads find only in their own blocks",
        "engine/kernels/force_field.cpp",
        "if (feels_varying && !in_turn) {",
        "if (feels_varying && !in_turn && system.particles.count() == 0) {",
        "engine_tests:StrainedPairs.HaveTheSameBitsOnAnyNumberOfThreads",
    ),
]
