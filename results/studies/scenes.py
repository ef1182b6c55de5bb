"""Scenes that several studies share, and patches of them."""


def merged(base, *patches, **more):
    """Returns a copy of `base` with the patches merged into it, objects key by key, and last the keyword arguments.

    None removes a key.
    """
    result = dict(base)
    for key, value in (pair for patch in (*patches, more) for pair in patch.items()):
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        else:
            result[key] = value
    return result


# The published system without noise and friction, at Stokes number 0.045.
REFERENCE_SCENE = {
    "particles": {
        "count": 1000,
        "density": 0.1,
        "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
    },
    "volume_fraction": 0.5,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.045},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05},
    "duration": {"equilibration": {"strain": 1}, "production": {"strain": 2}},
}

# Table 4.1 of Li's thesis with N = 250. Windows are in strain or, at small Peclet numbers, in Brownian times. Ten
# Brownian times are too few for equilibration: the viscosity at Pe = 0.1 and phi = 0.5 still rises after 50
# (results/steady-state); a^2 / D_0 is 19 Brownian times.
TABLE_SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {"count": 250},
        "flow": None,
        "peclet": 1,
        "limits": {"shear_rate": 0.009, "thermal_energy": 0.017},
        "duration": {
            "equilibration": {"strain": 1, "brownian_times": 100},
            "production": {"strain": 2, "brownian_times": 40},
        },
    },
)


def at_peclet(number):
    """Returns a patch: noise and flow at this Peclet number, up to five times as fast as in the published table."""
    return {"flow": None, "peclet": number, "limits": {"shear_rate": 0.045, "thermal_energy": 0.017}}


def during(equilibration, production):
    """Returns a patch with the two durations of a realisation."""
    return {"duration": {"equilibration": equilibration, "production": production}}


def in_strains(equilibration, production):
    return during({"strain": equilibration}, {"strain": production})


def in_brownian_times(equilibration, production):
    return during({"brownian_times": equilibration}, {"brownian_times": production})
