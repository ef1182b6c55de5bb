"""Fine mistakes in oscillatory shear and in the load of friction; see named_mutations.py."""

OSCILLATION = [
    (
        "moduli of implicit steps as of their end",
        "engine/observables/oscillation.cpp",
        "Method::implicit_steps ? 0.5 : 1.0",
        "Method::implicit_steps ? 1.0 : 1.0",
        "engine_tests:EitherMethod/Moduli.AreThoseOfAStressThatIsASumOfHarmonics/implicit",
    ),
    (
        "friction of the whole force beyond the critical load",
        "engine/terms/contact.h",
        "overlap) - Real{contact.critical_load};",
        "overlap) - Real{0.0};",
        "engine_tests:ContactOfTwo.HasNoFrictionBelowTheCriticalLoad",
    ),
    (
        "rate of an oscillation in phase with its strain",
        "engine/flow/shear.h",
        "return simple_shear(amplitude_ * frequency_ * std::cos(frequency_ * time));",
        "return simple_shear(amplitude_ * frequency_ * std::sin(frequency_ * time));",
        "engine_tests:OscillatoryShear.GoesToAndFro",
    ),
]
