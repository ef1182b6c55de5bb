"""Random configurations: spheres with gaps and overlaps around zero, velocities, springs and noise."""
import copy

import numpy as np

from evaluator.evaluation import flow_of, pairs_of
from evaluator.geometry import across, lattice

# Radius and number of spheres.
MIXTURES = {"1": {1: 30}, "1-1.4": {1: 22, 1.4: 8}, "1-3": {1: 54, 3: 2}, "1-1.4-5-7": {1: 110, 1.4: 40, 5: 1, 7: 1}}
VOLUME_FRACTION = 0.52
ADVANCE = 1e-3
# Every term that a scene can have.
SCENE = {
    "fluid": {"viscosity": 0.1, "thermal_energy": 0.017},
    "flow": {"shear_rate": 0.7},
    "contact": {
        "normal_stiffness": 1e4,
        "normal_damping": 1.3,
        "tangential_stiffness": 1e4 * 2 / 7,
        "friction": 0.5,
        "rolling_stiffness": 700.0,
        "rolling_friction": 0.2,
    },
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "repulsion": {"form": "exponential", "strength": 0.17, "relative_length": 0.01, "cutoff_lengths": 20},
    "attraction": {"hamaker": 0.3, "regularisation": 0.01, "cutoff": 1.0},
}


# Keys of the ranges of laws.
REACHES = ("outer_gap", "outer_distance", "relative_length", "debye_length", "cutoff")


def varied(scene, generator):
    """Returns the scene with numbers up to three times larger or smaller. Ranges do not grow, or a particle
    could meet its own image; the outer gap is one of three values."""

    def other(key, value):
        if not isinstance(value, float):
            return value
        return value * float(3 ** generator.uniform(-1, 0 if key in REACHES else 1))

    result = {block: {key: other(key, value) for key, value in entries.items()} for block, entries in scene.items()}
    if "outer_gap" in result.get("lubrication", {}):
        result["lubrication"]["outer_gap"] = float(generator.choice([0.05, 0.2, 0.4]))
    return result


def with_only(scene, block):
    """Returns the scene with the pair law of one block alone."""
    return {name: entries for name, entries in scene.items() if name in ("fluid", "flow", block)}


def packed(radius, box, generator):
    """Returns random positions, pushed apart until spheres enlarged by a five-hundredth overlap by less than
    a thousandth: true gaps scatter around zero."""
    vectors = lattice(box)
    position = generator.uniform(size=(len(radius), 3)) @ vectors
    wanted = 1.002 * (radius[:, None] + radius)
    np.fill_diagonal(wanted, 0)
    share = (1 / radius)[:, None] / (1 / radius[:, None] + 1 / radius)
    for _ in range(5000):
        separation = position[None] - position[:, None]
        separation -= np.rint(separation @ np.linalg.inv(vectors)) @ vectors
        distance = np.linalg.norm(separation, axis=2) + np.eye(len(radius))
        overlap = np.maximum(wanted - distance, 0)
        if overlap.max() < 1e-3:
            break
        position -= np.sum((0.5 * share * overlap / distance)[:, :, None] * separation, axis=1)
    return position


def random_state(mixture, scene, generator):
    radius = np.repeat([*map(float, MIXTURES[mixture])], [*MIXTURES[mixture].values()])
    edge = max((4 / 3 * np.pi * np.sum(radius**3) / VOLUME_FRACTION) ** (1 / 3), 2.5 * radius.max())
    box = {"lengths": [edge] * 3, "tilt": generator.uniform(-0.5, 0.5) * edge}
    position = packed(radius, box, generator) + 3e-3 * generator.normal(size=(len(radius), 3))
    flow, height = flow_of(scene, {"box": box}), position[:, 1]
    velocity = flow.velocity(height) + 0.3 * generator.normal(size=position.shape)
    spin = 0.3 * generator.normal(size=position.shape) + flow.spin(height)
    return {
        "box": box,
        "radius": radius.tolist(),
        "position": position.tolist(),
        "velocity": velocity.tolist(),
        "angular_velocity": spin.tolist(),
    }


def named(pairs, **vectors):
    """Yields pairs with vectors in the format of a configuration."""
    for k, (i, j, image) in enumerate(pairs.names()):
        yield {"i": i, "j": j, "image": list(image), **{name: rows[k].tolist() for name, rows in vectors.items()}}


def random_springs(pairs, generator):
    """Returns springs of about the length of the overlap, so that some slide and others do not."""
    touching = pairs.where(pairs.overlap > 0)
    size = touching.overlap[:, None]
    tangential, rolling = (across(touching.normal, generator.normal(size=(len(touching), 3))) for _ in range(2))
    return [*named(touching, tangential=size * tangential, rolling=3 * size * rolling)]


def random_noise(pairs, count, generator):
    theta, chi = generator.normal(size=(2, len(pairs), 3))
    force, torque = generator.normal(size=(2, count, 3)).tolist()
    return {"timestep": 1e-4, "force": force, "torque": torque, "pairs": [*named(pairs, theta=theta, chi=chi)]}


def state_of(lines):
    """Returns cell, centres, radii and velocities of a final.xyz written by an engine."""
    edges = np.array(lines[1].split('Lattice="')[1].split('"')[0].split(), float).reshape(3, 3)
    numbers = np.loadtxt(lines[2:], ndmin=2)
    return {
        "box": {"lengths": np.diag(edges).tolist(), "tilt": edges[1, 0]},
        "radius": numbers[:, 4].tolist(),
        "position": numbers[:, 1:4].tolist(),
        "velocity": numbers[:, 5:8].tolist(),
    }


def packed_configuration(lines, scene, seed):
    """Returns the configuration of an engine's packing, with random spins, springs and noise."""
    generator, state = np.random.default_rng(seed), state_of(lines)
    flow, count = flow_of(scene, state), len(state["radius"])
    height = np.array(state["position"])[:, 1]
    state["angular_velocity"] = (flow.spin(height) + 0.3 * generator.normal(size=(count, 3))).tolist()
    configuration = {"scene": copy.deepcopy(scene), "state": state}
    add_springs_and_noise(configuration, pairs_of(configuration), generator)
    return configuration


def add_springs_and_noise(configuration, pairs, generator):
    """Adds springs if the scene has friction, and noise if it has a thermal energy."""
    scene, state = configuration["scene"], configuration["state"]
    if scene.get("contact", {}).get("friction", 0) > 0:
        state["springs"] = random_springs(pairs, generator)
        configuration["advance"] = ADVANCE
    if "thermal_energy" in scene["fluid"]:
        state["noise"] = random_noise(pairs, len(state["radius"]), generator)


def random_configuration(mixture, scene, seed):
    """Returns a configuration with a contact, and with a pair that interacts across the moving boundary."""
    generator = np.random.default_rng(seed)
    for _ in range(20):
        state = random_state(mixture, scene, generator)
        configuration = {"scene": copy.deepcopy(scene), "state": state}
        pairs = pairs_of(configuration)
        if np.any(pairs.overlap > 0) and (np.any(pairs.image[:, 1] != 0)):
            break
    else:
        raise ValueError(f"no packing of {mixture} has a contact and a pair over the boundary")
    add_springs_and_noise(configuration, pairs, generator)
    return configuration
