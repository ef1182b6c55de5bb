"""Scenes of the suspensions of Monti, Rathee, Shen & Rosti (2021), in units of the small radius, the solvent's
viscosity and the shear rate."""
import math

from studies.scenes import merged

# F_R/F_A is 19 in their Table 3 and 9 in their public program. The program has forces in units of 6 pi eta a^2 rate,
# their equation 14 in units of eta a^2 rate.
TABLE_RATIO, PROGRAM_RATIO = 19, 9
DRAG = 6 * math.pi
REGULARISATION = 1e-3  # of lubrication; not published
ATTRACTION_REGULARISATION = 0.01  # eps over the pair's radius
# Attraction is cut off at half a radius, where it is 1/2500 of that at contact. The published cut-off of 4 costs ten
# times as much; the silica study compares the two.
ATTRACTION_RANGE, PUBLISHED_RANGE = 0.5, 4


def lubrication(outer, regularisation=REGULARISATION):
    """Returns the lubrication block, with terms for surface distances below `outer`."""
    return {"form": "mari", "regularisation": regularisation, "outer_distance": outer}


def kim_karrila(outer, inner=REGULARISATION):
    """Returns the lubrication block of the other studies, with the same gaps between spheres of radius 1."""
    return {"form": "kim-karrila", "inner_gap": inner, "outer_gap": outer}


def contact(stiffness, friction):
    """Returns the contact block: k_t = 2/7 k_n, gamma_n = 1e-7 k_n / rate."""
    return {"normal_stiffness": stiffness, "normal_damping": 1e-7 * stiffness, "friction": friction}


def spheres(count, fraction, second, share):
    """Returns a patch: spheres of radius 1 and of radius `second`, which have `share` of the volume."""
    species = [{"radius": 1.0, "volume_share": 1 - share}, {"radius": second, "volume_share": share}]
    return {"particles": {"count": count, "species": species}, "volume_fraction": fraction}


# St = 1e-3 and k_n = 4e5 eta a rate, as in all of their tables. Their program has no guard; near jamming such spheres
# overlap by more than the default guard of 0.05.
SCENE = {
    "particles": {"count": 1000, "density": 1e-3},
    "fluid": {"viscosity": 1.0},
    "flow": {"shear_rate": 1.0},
    "contact": contact(4e5, 0),
    "lubrication": lubrication(0.05),
    "guard": {"largest_overlap": 0.3},
    "seeds_in_common": True,  # differences between scenes are taken seed by seed
}
# Scene of their Table 1: FL without, FR with friction.
PAIRS = merged(SCENE, spheres(1000, 0.5, 1.4, 0.5))


def electrochemistry(contact_force, ratio, debye_length, attraction_range=ATTRACTION_RANGE):
    """Returns a patch: repulsion F_R exp(-h / lambda) and van der Waals attraction.

    F_R + F_A = contact_force for two spheres of radius 1 in contact, F_R = ratio F_A, lambda = debye_length.
    """
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
    """Returns a scene with the same dimensionless groups whose viscosity, rate and radii are multiplied by these
    factors. It has spheres with contacts and lubrication."""
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
