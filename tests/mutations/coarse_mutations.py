"""Coarse mistakes, each tried with every study and every test of the engine and the physics.

Name; file, text in it that occurs once, and its replacement.
"""

COARSE = [
    (
        "plus sign in the second Brownian torque",
        "engine/terms/pair_resistance.h",
        "root.pump_second * turned - root.spin_second * spun",
        "root.pump_second * turned + root.spin_second * spun",
    ),
    (
        "noise of half the variance",
        "engine/kernels/pair_pass.cpp",
        "std::sqrt(2 * physics.thermal_energy / timestep)",
        "std::sqrt(physics.thermal_energy / timestep)",
    ),
    (
        "image velocity missing",
        "engine/state/periodic_cell.cpp",
        "edge_velocities_ = velocity_gradient_ * edges_;",
        "edge_velocities_ = 0 * (velocity_gradient_ * edges_);",
    ),
    (
        "torque coupling of lubrication omitted",
        "engine/terms/pair_resistance.h",
        "      .pump_first = k.pump_first * pump,\n      .pump_second = k.pump_second * pump,\n",
        "      .pump_first = 0.0 * pump,\n      .pump_second = 0.0 * pump,\n",
    ),
    (
        "squeeze mode doubled",
        "engine/terms/pair_resistance.h",
        ".squeeze_inverse = six * 2 * b * b / cube",
        ".squeeze_inverse = six * 4 * b * b / cube",
    ),
    (
        "shear mode with another sign",
        "engine/terms/lubrication.h",
        "(R.squeeze * closing) * n + R.shear * sliding",
        "(R.squeeze * closing) * n - R.shear * sliding",
    ),
    (
        "every pair counted twice in the stress",
        "engine/observables/production.cpp",
        "stress[t] += block.stress[t];",
        "stress[t] += 1.4142135623730951 * block.stress[t];",
    ),
    (
        "contact half as stiff",
        "engine/terms/contact.h",
        "return normal_stiffness * overlap;",
        "return 0.5 * normal_stiffness * overlap;",
    ),
    (
        "spheres carried round the wrong way",
        "engine/flow/background_flow.h",
        "0.5 * (x.y - y.x)};",
        "-0.5 * (x.y - y.x)};",
    ),
    (
        "drag of a slip sphere",
        "engine/terms/drag.h",
        "return 6 * std::numbers::pi * viscosity * radius;",
        "return 4 * std::numbers::pi * viscosity * radius;",
    ),
    (
        "hollow spheres",
        "engine/state/particles.cpp",
        "particles.inertia.push_back(0.4 * mass",
        "particles.inertia.push_back(2.0 / 3 * mass",
    ),
    (
        "friction twice as strong",
        "engine/terms/spring_laws.h",
        "(Law::coefficient(parameters) / Law::stiffness(parameters))",
        "(2 * Law::coefficient(parameters) / Law::stiffness(parameters))",
    ),
    (
        "contact spring that is not turned",
        "engine/terms/tangential_spring.h",
        "Vector3Of<Real> turned = across(spring, normal);",
        "Vector3Of<Real> turned = spring + Real{0.0} * across(spring, normal);",
    ),
    ("repulsion of twice the range", "engine/terms/repulsion.h", ".decay = 1 / length", ".decay = 0.5 / length"),
    (
        "structural stress from one side of each pair",
        "engine/observables/structure.cpp",
        "within(kind.radius_first) + within(kind.radius_second)",
        "within(kind.radius_first)",
    ),
    (
        "gap clamped at ten times the inner gap",
        "engine/terms/pair_resistance.h",
        "Real here = larger(gap_of<shifted>(gap, pair), Real{gap.inner});",
        "Real here = larger(gap_of<shifted>(gap, pair), Real{10 * gap.inner});",
    ),
]
