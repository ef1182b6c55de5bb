"""Fine mistakes in static and kinetic friction; see named_mutations.py."""

KINETIC = [
    (
        "contacts that slide held by static friction",
        "engine/terms/friction.h",
        "select(slides > 0.5, kinetic, longest_spring(contact, overlap))",
        "longest_spring(contact, overlap)",
        "engine_tests:KineticFrictionOfTwo.BreaksAwayAtTheStaticForceAndSlidesAtTheKineticOne",
    ),
    (
        "sliding remembered without load",
        "engine/terms/friction.h",
        "(length > limits.longest) & (frictional_load(contact, overlap) > 0.0)",
        "length > limits.longest",
        "engine_tests:KineticFrictionOfTwo.OfBothKindsGoesByWhatExceedsTheCriticalLoad",
    ),
    (
        "sliding without a spring forgotten with the list",
        "engine/state/contact_history.cpp",
        " && of_pair.slides == 0)",
        ")",
        "engine_tests:ContactHistory.ContactsThatSlideAreHeldWithoutASpring",
    ),
    (
        "stiffness of contacts that slide as of those that stick",
        "engine/kernels/links/link_assembly.h",
        "if (terms.kinetic) {",
        "if (terms.kinetic && false) {",
        "engine_tests:EverySet/LinkKernelsOf.HaveTheSecantStiffnessOfContactsThatSlide/baseline",
    ),
    (
        "damping where a kernel has it and its terms do not",
        "engine/kernels/pair_pass.cpp",
        "if (!damps_) ",
        "if (false) ",
        "engine_tests:PairPass.EqualsTheSumOfItsTermsForEveryRecipe",
    ),
]
