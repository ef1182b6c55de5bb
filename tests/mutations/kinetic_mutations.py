"""Fine mistakes in static and kinetic friction; see named_mutations.py."""

KINETIC = [
    (
        "sliding without a spring forgotten with the list",
        "engine/state/contact_history.cpp",
        " && of_pair.slides == 0)",
        ")",
        "engine_tests:ContactHistory.ContactsThatSlideAreHeldWithoutASpring",
    ),
    (
        "damping where a kernel has it and its terms do not",
        "engine/kernels/pair_pass.cpp",
        "if (!damps_) ",
        "if (false) ",
        "engine_tests:PairPass.EqualsTheSumOfItsTermsForEveryRecipe",
    ),
    (
        "a tangential dashpot beyond Coulomb's law",
        "engine/terms/spring_laws.h",
        "return cut_to(spring + ahead, limit);",
        "return spring + ahead;",
        "engine_tests:TangentialDampingOfTwo.IsLimitedTogetherWithTheSpring",
    ),
    (
        "a tangential dashpot left out of implicit steps",
        "engine/terms/spring_laws.h",
        "if (damped) add(weights.resistance, resistance);",
        "",
        "engine_tests:TangentialDampingOfTwo.CouplesAsTheChangeOfItsForce",
    ),
]
