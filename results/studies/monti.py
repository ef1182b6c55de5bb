"""Scenes of the suspensions of Monti, Rathee, Shen & Rosti (2021), in units of the small radius, the solvent's
viscosity and the shear rate."""
import math

from studies.scenes import merged

# Their Table 3 has F_R/F_A = 19, their public program 9; that one measures forces in 6 pi eta a^2 rate, their equation
# 14 in eta a^2 rate.
TABLE_RATIO, PROGRAM_RATIO = 19, 9
DRAG = 6 * math.pi
REGULARISATION = 1e-3  # of lubrication; not published
ATTRACTION_REGULARISATION = 0.01  # eps over the pair's radius
# Attraction is left out beyond half a radius, where it is 1/2500 of that at contact; published: 4, at ten times the
# cost. The silica study compares the two.
ATTRACTION_RANGE, PUBLISHED_RANGE = 0.5, 4


def lubrication(outer, regularisation=REGULARISATION):
    """The block, with terms for surfaces nearer than `outer`."""
    return {"form": "mari", "regularisation": regularisation, "outer_distance": outer}


def kim_karrila(outer, inner=REGULARISATION):
    """The block of the other studies, with the same gaps of two spheres of radius 1."""
    return {"form": "kim-karrila", "inner_gap": inner, "outer_gap": outer}


def contact(stiffness, friction):
    """The block: k_t = 2/7 k_n, gamma_n = 1e-7 k_n / rate."""
    return {"normal_stiffness": stiffness, "normal_damping": 1e-7 * stiffness, "friction": friction}


def spheres(count, fraction, second, share):
    """A patch: spheres of radius 1 and of a second one with this share of the volume."""
    species = [{"radius": 1.0, "volume_share": 1 - share}, {"radius": second, "volume_share": share}]
    return {"particles": {"count": count, "species": species}, "volume_fraction": fraction}


# St = 1e-3, k_n = 4e5 eta a rate: the same in all of their tables. Their program has no guard; near jamming spheres of
# this stiffness overlap by more than the guard's 0.05.
SCENE = {
    "particles": {"count": 1000, "density": 1e-3},
    "fluid": {"viscosity": 1.0},
    "flow": {"shear_rate": 1.0},
    "contact": contact(4e5, 0),
    "lubrication": lubrication(0.05),
    "guard": {"largest_overlap": 0.3},
}
# Their Table 1: FL without and FR with friction.
PAIRS = merged(SCENE, spheres(1000, 0.5, 1.4, 0.5))


def electrochemistry(contact_force, ratio, debye_length, attraction_range=ATTRACTION_RANGE):
    """A patch: repulsion F_R exp(-h / lambda) and van der Waals attraction, F_R + F_A = contact_force of two spheres of
    radius 1 that touch, F_R = ratio F_A."""
    attraction = contact_force / (1 + ratio)
    eps = ATTRACTION_REGULARISATION
    return {
        "repulsion": {
            "form": "screened",
            "force": ratio * attraction,
            "debye_length": debye_length,
            "reference_radius": 1.0,
        },
        "attraction": {"hamaker": 12 * eps * eps * attraction, "regularisation": eps, "cutoff": attraction_range},
    }


def in_units(scene, viscosity, rate, length):
    """A scene of spheres with contacts and lubrication, with the same groups, whose viscosity, rate and radii are so
    many times as large."""
    force = viscosity * rate * length * length
    particles, block = scene["particles"], scene["contact"]
    stiffness, damping = block["normal_stiffness"] * force / length, block["normal_damping"] * force / length / rate
    return merged(
        scene,
        particles={
            "density": particles["density"] * viscosity / (length * length * rate),
            "species": [s | {"radius": s["radius"] * length} for s in particles["species"]],
        },
        fluid={"viscosity": scene["fluid"]["viscosity"] * viscosity},
        flow={"shear_rate": scene["flow"]["shear_rate"] * rate},
        contact={"normal_stiffness": stiffness, "normal_damping": damping},
        lubrication={"outer_distance": scene["lubrication"]["outer_distance"] * length},
    )
