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
]
