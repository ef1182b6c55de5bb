"""The panels of the chart of results/speed-accuracy, and the columns of its tables."""
import dataclasses

from studies.scenes import at_peclet, during

COLUMNS = "panel", "method", "step", "timestep", "tolerance", "seeds", "lost", "flags", "viscosity", "viscosity_error"
COLUMNS += "bias_percent", "bias_half_width_percent", "pressure", "pressure_error", "pressure_bias_percent"
COLUMNS += "pressure_bias_half_width_percent", "seconds_per_strain", "seconds_to_2_percent", "particles", "commit"


@dataclasses.dataclass
class Case:
    """A panel of the chart.

    patch         difference from the reference scene
    seeds         number of seeds
    explicit      explicit steps over the largest stable one, with their seeds if different
    implicit      implicit steps over the automatic one, with their seeds if different
    tolerances    of the solver, at the automatic step
    """

    patch: dict
    seeds: int
    explicit: dict = dataclasses.field(default_factory=lambda: {0.5: None})
    implicit: dict = dataclasses.field(default_factory=lambda: dict.fromkeys((0.5, 1, 2)))
    tolerances: tuple = ()


BROWNIAN = {**during({"brownian_times": 10}, {"brownian_times": 40}), "particles": {"count": 250}}
ONE_AND_TWO = dict.fromkeys((1, 2))
UP_TO_FOUR = dict.fromkeys((0.5, 1, 2, 3.99))
NARROW = {"lubrication": {"inner_gap": 1e-4}, "particles": {"count": 250}}
SIZES = {
    "particles": {"count": 3000, "species": [{"radius": radius, "volume_share": 0.25} for radius in (1, 1.4, 5, 7)]}
}
ROUGH = {"contact": {"friction": 1}}

PANELS = {
    "reference": Case({}, 8, dict.fromkeys((0.5, 0.999)), dict.fromkeys((0.25, 0.5, 1, 2, 3.99)), (1e-4,)),
    "friction 1, phi 0.45": Case({**ROUGH, "volume_fraction": 0.45}, 8, implicit=UP_TO_FOUR, tolerances=(1e-4,)),
    "friction 1": Case(ROUGH, 4),
    "N 250": Case({"particles": {"count": 250}}, 16, implicit=ONE_AND_TWO),
    "N 4000": Case({"particles": {"count": 4000}}, 2, implicit=ONE_AND_TWO),
    "outer gap 0.2": Case({"lubrication": {"outer_gap": 0.2}}, 4, implicit=ONE_AND_TWO),
    "outer gap 0.5": Case({"lubrication": {"outer_gap": 0.5}}, 2, implicit=ONE_AND_TWO),
    "inner gap 0.01": Case({"lubrication": {"inner_gap": 1e-2}}, 4),
    "inner gap 0.0001": Case(NARROW, 8, explicit={0.5: 4}),
    "stiffness 1000": Case({"contact": {"normal_stiffness": 1e3}}, 4),
    "stiffness 100000": Case({"contact": {"normal_stiffness": 1e5}}, 4),
    "radii 1 to 7": Case(SIZES, 2, implicit=dict.fromkeys((0.5, 1, 2))),
    "Pe 100": Case(at_peclet(100), 48, {0.5: 16}, {0.25: 100, 0.5: None, 1: 100, 2: None, 3.99: None}),
    "Pe 10": Case(at_peclet(10), 48, {0.5: 16}, {0.25: 600, 0.5: None, 1: 600, 2: None, 3.99: None}),
    "Pe 1": Case({**at_peclet(1), **BROWNIAN}, 48, {0.5: 16}, {0.25: 200, 0.5: None, 1: 200, 2: None, 3.99: None}),
    "Pe 0.1": Case({**at_peclet(0.1), **BROWNIAN}, 64, {0.5: 24}, {0.5: None, 1: 128, 2: None}),
}
