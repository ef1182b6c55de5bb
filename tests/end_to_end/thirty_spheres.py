"""A scene of real physics that takes no time: thirty spheres with lubrication, sheared."""


def thirty_spheres(equilibration, production):
    """Returns the scene with these strains of equilibration and production."""
    return {
        "particles": {
            "count": 30,
            "density": 0.1,
            "species": [{"radius": 1.0, "volume_share": 0.5}, {"radius": 1.4, "volume_share": 0.5}],
        },
        "volume_fraction": 0.3,
        "fluid": {"viscosity": 0.1},
        "flow": {"shear_rate": 0.05},
        "contact": {"normal_stiffness": 1e4},
        "lubrication": {"form": "kim-karrila", "inner_gap": 0.01, "outer_gap": 0.05},
        "duration": {"equilibration": {"strain": equilibration}, "production": {"strain": production}},
    }
