"""The laws of a scene, and their forces on a configuration."""
import numpy as np

from evaluator.geometry import lattice, pairs_within
from evaluator.laws import contact, flow, lubrication, strained_lubrication, stress, surface_forces


class Answer:
    """Force, torque and stress of each term, to which loads are added."""

    def __init__(self, count, volume):
        self.count, self.volume = count, volume
        self.force, self.torque, self.stress = {}, {}, {}

    def _start(self, term):
        if term not in self.force:
            self.force[term], self.torque[term] = np.zeros((2, self.count, 3))
            self.stress[term] = np.zeros((3, 3))

    def add_single(self, term, force, torque):
        self._start(term)
        self.force[term] += force
        self.torque[term] += torque

    def add_pairs(self, term, pairs, force, torque_i=None, torque_j=None):
        self._start(term)
        np.add.at(self.force[term], pairs.i, force)
        np.add.at(self.force[term], pairs.j, -force)
        if torque_i is not None:
            np.add.at(self.torque[term], pairs.i, torque_i)
            np.add.at(self.torque[term], pairs.j, torque_j)
        self.stress[term] += stress.pair_stress(pairs, force, self.volume)

    def as_json(self):
        def listed(block):
            return {term: value.tolist() for term, value in block.items()}

        return {"force": listed(self.force), "torque": listed(self.torque), "stress": listed(self.stress)}


def outermost(block, sums):
    """Returns the surface distance at which lubrication ends, by the sum of the radii."""
    if block["form"] == "mari":
        return block["outer_distance"] + 0 * sums
    return block["outer_gap"] * sums / 2


def screening_length(repulsion, sums):
    if repulsion["form"] == "screened":
        return repulsion["debye_length"] + 0 * sums
    return repulsion["relative_length"] * sums


def reach_of(scene):
    """Returns the centre distance within which two spheres interact, by their radii."""

    def reach(a_i, a_j):
        sums = a_i + a_j
        surface = [0 * sums]
        if "lubrication" in scene:
            surface.append(outermost(scene["lubrication"], sums))
        if "repulsion" in scene:
            surface.append(scene["repulsion"]["cutoff_lengths"] * screening_length(scene["repulsion"], sums))
        if "attraction" in scene:
            surface.append(scene["attraction"]["cutoff"] + 0 * sums)
        return sums + np.max(surface, axis=0)

    return reach


def given(pairs, listed, *names):
    """Returns vectors of these names in the order of `pairs`; zero for pairs that are not listed."""
    by_name = {(entry["i"], entry["j"], tuple(entry["image"])): entry for entry in listed}
    found = [by_name.get(name) for name in pairs.names()]
    return [np.array([entry[n] if entry else (0, 0, 0) for entry in found], float).reshape(-1, 3) for n in names]


def springs_after(scene, state, pairs, time):
    """Returns the tangential and rolling springs of pairs in contact."""
    block = scene["contact"]
    normal_force = block["normal_stiffness"] * pairs.overlap
    tangential, rolling = given(pairs, state.get("springs", []), "tangential", "rolling")
    held = []
    for spring, kind, velocity in (
        (tangential, ("tangential_stiffness", "friction"), contact.slip_velocity),
        (rolling, ("rolling_stiffness", "rolling_friction"), contact.rolling_velocity),
    ):
        stiffness, coefficient = (block.get(name, 0) for name in kind)
        longest = coefficient * normal_force / stiffness if stiffness else 0 * normal_force
        held.append(contact.held_spring(pairs, spring, velocity(pairs), time, longest))
    return held


def add_contact(answer, scene, state, pairs):
    block = scene["contact"]
    touching = pairs.where(pairs.overlap > 0)
    answer.add_pairs("contact_normal", touching, contact.contact_normal(touching, block["normal_stiffness"]))
    if "normal_damping" in block:
        answer.add_pairs("contact_damping", touching, contact.contact_damping(touching, block["normal_damping"]))
    if block.get("friction", 0) > 0:
        tangential, rolling = springs_after(scene, state, touching, 0)
        stiffness, damping = block["tangential_stiffness"], block.get("tangential_damping", 0)
        limit = block["friction"] * block["normal_stiffness"] * touching.overlap
        answer.add_pairs("friction", touching, *contact.friction(touching, tangential, stiffness, damping, limit))
        if "rolling_stiffness" in block:
            answer.add_pairs("rolling", touching, *contact.rolling(touching, rolling, block["rolling_stiffness"]))


def add_lubrication(answer, scene, state, pairs):
    block, viscosity = scene["lubrication"], scene["fluid"]["viscosity"]
    near = pairs.where(pairs.surface_distance <= outermost(block, pairs.radius_i + pairs.radius_j))
    if block["form"] == "mari":
        load = strained_lubrication.mari_lubrication(near, viscosity, block["regularisation"], flow_of(scene, state))
    else:
        load = lubrication.lubrication(near, viscosity, block["inner_gap"])
    answer.add_pairs("lubrication", near, *load)
    if "noise" in state:
        vectors = given(near, state["noise"]["pairs"], "theta", "chi")
        load = lubrication.lubrication_noise(near, viscosity, block["inner_gap"], amplitude_of(scene, state), *vectors)
        answer.add_pairs("brownian_lubrication", near, *load)


def numbers(block):
    """Returns the parameters of a law by the names of the scene."""
    return {name: value for name, value in block.items() if name != "form"}


def add_repulsion(answer, scene, _, pairs):
    form = scene["repulsion"]["form"]
    law = surface_forces.screened_repulsion if form == "screened" else surface_forces.exponential_repulsion
    answer.add_pairs("repulsion", pairs, law(pairs, **numbers(scene["repulsion"])))


def add_attraction(answer, scene, _, pairs):
    answer.add_pairs("attraction", pairs, surface_forces.attraction(pairs, **numbers(scene["attraction"])))


# Blocks of a scene, and the functions that add their terms.
PAIR_TERMS = {
    "contact": add_contact,
    "lubrication": add_lubrication,
    "repulsion": add_repulsion,
    "attraction": add_attraction,
}


def flow_of(scene, state):
    return flow.Flow(scene["flow"], state["box"]["lengths"][1])


def amplitude_of(scene, state):
    return np.sqrt(2 * scene["fluid"]["thermal_energy"] / state["noise"]["timestep"])


def add_singles(answer, scene, state):
    viscosity, stream = scene["fluid"]["viscosity"], flow_of(scene, state)
    radius, position, velocity, spin = (
        np.array(state[name], float) for name in ("radius", "position", "velocity", "angular_velocity")
    )
    answer.add_single("drag", *flow.drag(radius, position, velocity, spin, viscosity, stream))
    if "noise" in state:
        vectors = (np.array(state["noise"][name], float) for name in ("force", "torque"))
        load = flow.drag_noise(radius, viscosity, amplitude_of(scene, state), *vectors)
        answer.add_single("brownian_drag", *load)
    answer.stress["solvent"] = stress.solvent_stress(viscosity, stream.shear_rate)
    answer.stress["stresslet"] = stress.stresslet(radius, position[:, 1], viscosity, stream, answer.volume)


def pairs_of(configuration):
    scene, state = configuration["scene"], configuration["state"]
    return pairs_within(state, scene["flow"]["shear_rate"], reach_of(scene))


def evaluate(configuration):
    """Returns the expected answer of `peclet-engine forces`."""
    scene, state = configuration["scene"], configuration["state"]
    pairs = pairs_of(configuration)
    answer = Answer(len(state["radius"]), np.linalg.det(lattice(state["box"])))
    for block, add in PAIR_TERMS.items():
        if block in scene:
            add(answer, scene, state, pairs)
    add_singles(answer, scene, state)
    document = answer.as_json()
    if "advance" in configuration:
        document["springs"] = advanced_springs(scene, state, pairs, configuration["advance"])
    return document


def advanced_springs(scene, state, pairs, time):
    if scene.get("contact", {}).get("friction", 0) == 0:
        return []
    touching = pairs.where(pairs.overlap > 0)
    springs = zip(touching.names(), *springs_after(scene, state, touching, time))
    return [
        {"i": i, "j": j, "image": list(image), "tangential": tangential.tolist(), "rolling": rolling.tolist()}
        for (i, j, image), tangential, rolling in springs
    ]


def largest_difference(expected, answer):
    """Returns by block and term the largest difference over the largest number of the term. Terms of zero up
    to rounding are compared on the scale of their block. A missing term gives infinity."""
    found = {}
    for block in ("force", "torque", "stress"):
        scale = max(np.abs(value).max() for value in expected[block].values())
        for term, value in expected[block].items():
            size = np.abs(value).max()
            other = answer[block].get(term)
            if other is None:
                found[f"{block}.{term}"] = np.inf if size > 0 else 0.0
            else:
                size = size if size > 1e-12 * scale else scale
                found[f"{block}.{term}"] = np.abs(np.subtract(other, value)).max() / (size or 1)
    return found | differences_of_springs(expected.get("springs", []), answer.get("springs", []))


def differences_of_springs(expected, answer):
    def by_name(springs):
        return {(s["i"], s["j"], tuple(s["image"])): s for s in springs}

    expected, answer = by_name(expected), by_name(answer)
    if expected.keys() != answer.keys():
        return {"springs": np.inf}
    found = {}
    for kind in ("tangential", "rolling") if expected else ():
        ours, theirs = (np.array([springs[name][kind] for name in expected]) for springs in (expected, answer))
        found[f"springs.{kind}"] = np.abs(ours - theirs).max() / (np.abs(ours).max() or 1)
    return found
