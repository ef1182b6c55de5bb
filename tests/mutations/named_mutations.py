"""Fine mistakes of a physicist's kind, each with the test of seconds that must fail.

Name; file, text in it that occurs once, its replacement; program and test.
"""

from card_mutations import MUTATIONS as CARD
from flow_mutations import FLOW
from kinetic_mutations import KINETIC
from oscillation_mutations import OSCILLATION
from response_mutations import RESPONSE
from strained_mutations import STRAINED

IMPLICIT, NOISY = "engine/integrators/implicit.cpp", "engine/integrators/noisy_midpoint.cpp"
SIMULATION, STRESS = "engine/realisation/simulation.cpp", "engine/realisation/stress_means.cpp"
LINE = "engine_tests:NoisyStep.OfTwoSpheresOnALineIsThatOfItsEquations"

NAMED = [
    (
        "the stiffness counts for the whole step",
        "engine/integrators/velocity_solver.h",
        ".normal_time = 0.5 * timestep_}",
        ".normal_time = timestep_}",
        LINE,
    ),
    (
        "with noise contacts are looked for a whole step ahead",
        NOISY,
        "at_beginning_(field_.physics(), particles, timestep, seed, threads, set, 0.5 * timestep,",
        "at_beginning_(field_.physics(), particles, timestep, seed, threads, set, timestep,",
        LINE,
    ),
    (
        "with noise the stress is that of the predicted middle",
        "engine/integrators/acted_stress.cpp",
        "symmetric_dyad(half * change_.velocity[i], force_ahead_[i] + force_of_change_[i])",
        "symmetric_dyad(0.0 * change_.velocity[i], force_ahead_[i] + force_of_change_[i])",
        LINE,
    ),
    (
        "stress of the noise at the middle of the step",
        "engine/integrators/acted_stress.cpp",
        "  sums_.of(carried_term(field.physics())) +=",
        "  sums_.of(StressTerm::brownian_lubrication) +=",
        "engine_tests:NoisyStep.HasTheStressOfItsNoiseWhereItWasDrawn",
    ),
    (
        "predictor without noise",
        NOISY,
        "  const bool predicted = solve(system, factor_of_prediction, report);",
        "  const Loads drawn = noise_;\n  noise_ = Loads(system.particles.count(), 1);\n"
        "  const bool predicted = solve(system, factor_of_prediction, report);\n  noise_ = drawn;",
        "physics_tests:NoisyDrift.OfALubricatedPairIsTheDivergenceOfItsMobility",
    ),
    (
        "target of Newton's iterations ten times too loose",
        "engine/integrators/midpoint.cpp",
        "std::max(solver_.tolerance() * solver_.tolerance() * motion, no_motion);",
        "std::max(100 * solver_.tolerance() * solver_.tolerance() * motion, no_motion);",
        "engine_tests:Implicit.LeavesNoLargerResidualThanItsTolerance",
    ),
    (
        "packings that overlap by 1 %",
        "engine/realisation/packing.cpp",
        "if (!(closest > 1)) {",
        "if (!(closest > 0.99)) {",
        "engine_tests:Packing.AcceptsNoOverlapHoweverSmall",
    ),
    (
        "Brownian times with 6 pi",
        "engine/scene/scene.cpp",
        "duration.brownian_times * physics.viscosity",
        "duration.brownian_times * 18.85 * physics.viscosity",
        "engine_tests:Schedule.ABrownianTimeIsEtaACubedOverTheThermalEnergy",
    ),
    (
        "half steps that are whole ones",
        IMPLICIT,
        "with_timestep(timestep_ / every, copy.particles)",
        "with_timestep(timestep_, copy.particles)",
        "engine_tests:Implicit.ComparesStepsWithHalfSteps",
    ),
    (
        "Green and Kubo by rectangles",
        "engine/observables/stress_correlation.cpp",
        "0.5 * (now - before) * (g + modulus_before)",
        "(now - before) * g",
        "engine_tests:StressCorrelation.IsIntegratedByTrapezia",
    ),
    (
        "stiffness of contacts counted twice in the share of stability",
        "engine/integrators/velocity_verlet.cpp",
        "0.25 * timestep_ * timestep_",
        "0.5 * timestep_ * timestep_",
        "engine_tests:VelocityVerlet.SharesOfStabilityWeighTheStiffnessOfAContact",
    ),
    (
        "strain of explicit steps one step late",
        "engine/flow/shear.h",
        "clock.timestep * static_cast<double>(clock.steps)",
        "clock.timestep * static_cast<double>(clock.steps - 1)",
        "engine_tests:VelocityVerlet.StrainAfterNStepsIsNTimesRateAndStep",
    ),
    (
        "strain of implicit steps one step late",
        IMPLICIT,
        "displacement_gradient(system.clock.time() + time)",
        "displacement_gradient(system.clock.time())",
        "engine_tests:Implicit.StrainAfterNStepsIsNTimesRateAndStep",
    ),
    (
        "noise torque missing from implicit steps",
        "engine/integrators/velocity_solver.cpp",
        "noise != nullptr ? noise->torque.data() : nullptr",
        "noise != nullptr ? [&] {\n  static VectorField none;\n  none = VectorField(noise->torque.size());\n"
        "  return none.data();\n}() : nullptr",
        "physics_tests:StepsOverDecayTimes/ImplicitSpheres.DiffuseAsTheNoiseSays/Tenths10",
    ),
    (
        "springs stretched twice in a step with noise",
        NOISY,
        "  restore_springs(system);\n  return sums;",
        "  return sums;",
        "engine_tests:Implicit.StretchesSpringsOnceAStep",
    ),
    (
        "torques of pairs across blocks on the other sphere",
        "engine/kernels/pair_kernel.h",
        "row_of(out.crossing, 2 * c + 1) = torque_first.row[k];",
        "row_of(out.crossing, 2 * c + 1) = torque_second.row[k];",
        "engine_tests:PairPass.DependsOnNoOrderOfTheParticlesInMemory",
    ),
    (
        "repulsion beside links left out",
        "engine/kernels/link_assembly.h",
        "            sums.add_stress(part, shape_, force);\n            load.force += force;",
        "            sums.add_stress(part, shape_, force);",
        "engine_tests:*LinkLoadsOf.AreThoseOfAnEvaluation*",
    ),
    (
        "noise of pairs for steps of half the length",
        NOISY,
        "      with_noise_(lubrication_alone(physics), particles, timestep, seed",
        "      with_noise_(lubrication_alone(physics), particles, 0.5 * timestep, seed",
        "engine_tests:NoisyStep.HasTheStressOfItsNoiseWhereItWasDrawn",
    ),
    (
        "displacement of implicit steps in the laboratory",
        IMPLICIT,
        "peculiar.x -= gradient.column[1].x * position.row(i)[1];",
        "peculiar.x -= 0 * gradient.column[1].x * position.row(i)[1];",
        "engine_tests:Implicit.ReportsTheLargestDisplacementRelativeToTheFlow",
    ),
    (
        "inertia of the prediction instead of the step's beginning",
        "engine/integrators/velocity_solver.cpp",
        ".velocity_before = origin.velocity().data()",
        ".velocity_before = particles.velocity.data()",
        LINE,
    ),
    (
        "checkpoint of implicit steps without the last change of spins",
        "engine/integrators/midpoint.cpp",
        "  archive.put_all(velocity_change_, spin_change_);",
        "  archive.put_all(velocity_change_, velocity_change_);",
        "engine_tests:EveryWay/ResumedRun.EndsAsTheUncutOneWhereverItWasCut/implicit_without_noise",
    ),
    (
        "checkpoint of explicit steps without torques",
        "engine/integrators/velocity_verlet.cpp",
        "  archive.put_all(force_, torque_);",
        "  archive.put_all(force_, force_);",
        "engine_tests:EveryWay/ResumedRun.EndsAsTheUncutOneWhereverItWasCut/explicit",
    ),
    (
        "checkpoint without the largest overlap",
        SIMULATION,
        "  archive.put_all(schedule_.equilibration, largest_overlap_, production_);",
        "  archive.put_all(schedule_.equilibration, 0.0, production_);",
        "engine_tests:ResumedJob.ResultEqualsTheUncutOneButForItsCost",
    ),
    (
        "checkpoint without the errors of the steps",
        SIMULATION,
        "  archive.put(errors_);",
        "  archive.put(StepErrors{});",
        "engine_tests:ResumedJob.ResultEqualsTheUncutOneButForItsCost",
    ),
    (
        "spins of the start as warm as if they were velocities",
        SIMULATION,
        "std::sqrt(physics.thermal_energy / particles.inertia[i])",
        "std::sqrt(physics.thermal_energy / particles.mass[i])",
        "engine_tests:InitialVelocities.AreThoseOfEquilibriumAboutTheFlow",
    ),
    (
        "spins of the start from the velocities' numbers",
        SIMULATION,
        "* normals.second;\n    }",
        "* normals.first;\n    }",
        "engine_tests:InitialVelocities.AreThoseOfEquilibriumAboutTheFlow",
    ),
    (
        "spheres of the start that do not turn with the flow",
        SIMULATION,
        "    Vector3 spin = flow.spin(particles.position[i]);",
        "    Vector3 spin = 0 * flow.spin(particles.position[i]);",
        "engine_tests:InitialVelocities.AreThoseOfEquilibriumAboutTheFlow",
    ),
    (
        "window that begins one step late",
        SIMULATION,
        "if (system_.step > schedule_.equilibration) {",
        "if (system_.step > schedule_.equilibration + 1) {",
        "engine_tests:Result.MeansAreTakenOverEveryStepOfTheProductionWindow",
    ),
    (
        "torques of single spheres from their forces' numbers",
        "engine/kernels/force_field.cpp",
        "{normal(3), normal(4), normal(5)}}",
        "{normal(0), normal(1), normal(2)}}",
        "engine_tests:PairPass.EqualsThePlainLoopOverAllPairs",
    ),
    (
        "noise of rotation with the drag of translation",
        "engine/kernels/force_field.cpp",
        "drag_noise_amplitude(parameters_.noise_amplitude, zeta_r)",
        "drag_noise_amplitude(parameters_.noise_amplitude, zeta)",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
    (
        "N1 with the other sign",
        STRESS,
        "return of.total.xx - of.total.yy; }",
        "return of.total.yy - of.total.xx; }",
        "engine_tests:Result.ViscosityAndNormalStressesAreThoseOfTheTotal",
    ),
    (
        "pressure with the other sign",
        STRESS,
        "return -(of.total.xx + of.total.yy + of.total.zz) / 3;",
        "return (of.total.xx + of.total.yy + of.total.zz) / 3;",
        "engine_tests:Result.ViscosityAndNormalStressesAreThoseOfTheTotal",
    ),
    (
        "correlations of blocks counted on one side",
        "engine/observables/production.cpp",
        "inefficiency += 2 * correlation",
        "inefficiency += correlation",
        "engine_tests:StatisticalInefficiency.SumsTheCorrelationUpToItsFirstZero",
    ),
    (
        "diffusion in a flow from two axes as if from three",
        "engine/observables/mean_squared_displacement.cpp",
        "1.5 * (own.y + own.z)",
        "(own.y + own.z)",
        "engine_tests:Flight.UnderShearHasTheSlopeOfTwoAxesForThree",
    ),
    (
        "friction mobilised without its coefficient",
        "engine/observables/structure.h",
        "force / (contact.friction * load)",
        "force / load",
        "engine_tests:ContactNetwork.CountsContactsAndTheirMobilisation",
    ),
    (
        "temperature of spins with the mass",
        "engine/observables/structure.cpp",
        "rotational += particles.inertia[i]",
        "rotational += particles.mass[i]",
        "engine_tests:KineticTemperatures.AreThoseOfMotionRelativeToTheStreamingFlow",
    ),
    (
        "structural shell of the larger sphere not listed",
        "engine/kernels/pair_kinds.cpp",
        "structural_shell * std::max(first, second)",
        "structural_shell * std::min(first, second)",
        "engine_tests:StructuralBrownianStress.SeesTheWholeShellOfTheLargerSphere",
    ),
    (
        "images of contacts kept through a flip",
        "engine/state/system.cpp",
        "contact.image = change.after(contact.image);",
        "contact.image = contact.image;",
        "engine_tests:ContactHistory.SurvivesFlipsInEitherDirection",
    ),
    (
        "relaxation before the start with noise",
        "engine/realisation/packing.cpp",
        "  still.thermal_energy = 0;\n",
        "",
        "engine_tests:Relaxation.LeavesAPackingWithoutForcesWhereItIs",
    ),
    (
        "relaxation before the start in a flow",
        "engine/realisation/packing.cpp",
        "  still.flow = {};\n",
        "",
        "engine_tests:Relaxation.LeavesAPackingWithoutForcesWhereItIs",
    ),
    (
        "implicit steps that leap out of the range of lubrication",
        "engine/integrators/stability.cpp",
        "leaps = 5;",
        "leaps = 0.5;",
        "engine_tests:ImplicitTimestep.LetsNoLightSphereLeapIntoAnother",
    ),
    (
        "leaps without inertia",
        "engine/integrators/stability.cpp",
        "const double inertia = mass + timestep * drag;",
        "const double inertia = 0 * mass + timestep * drag;",
        "engine_tests:ImplicitTimestep.IsBoundByLeapsOutOfTheRangeOfLubrication",
    ),
    (
        "z of the image missing from the key of the noise",
        "engine/terms/keyed_random.h",
        "(static_cast<std::uint64_t>(image.z) & mask) << 40",
        "(static_cast<std::uint64_t>(image.z) & 0) << 40",
        "engine_tests:KeyedRandom.EveryImageOfAPairHasItsOwnNoise",
    ),
    (
        "drag against the laboratory",
        "engine/kernels/one_body.h",
        "drag.translational * (streaming - velocity)",
        "drag.translational * (0.0 * streaming - velocity)",
        "engine_tests:ReferenceForces.EveryTermOfEveryMixtureEqualsTheIndependentEvaluation",
    ),
    (
        "overlaps of unlike spheres over the larger radius",
        "engine/kernels/pair_kinds.cpp",
        "kind.smaller_radius = std::min(first, second);",
        "kind.smaller_radius = std::max(first, second);",
        "engine_tests:Result.MeansAreTakenOverEveryStepOfTheProductionWindow",
    ),
    (
        "gaps counted as negative overlaps",
        "engine/kernels/pair_kernel.h",
        "overlaps += larger(Real{}, relative);",
        "overlaps += relative;",
        "engine_tests:Result.MeansAreTakenOverEveryStepOfTheProductionWindow",
    ),
]

NAMED += CARD + FLOW + KINETIC + OSCILLATION + RESPONSE + STRAINED
