"""Of the tables that the chart is drawn from."""

COLUMNS = (
    "panel",
    "method",
    "step",
    "timestep",
    "tolerance",
    "seeds",
    "lost",
    "flags",
    "viscosity",
    "viscosity_error",
    "bias_percent",
    "bias_half_width_percent",
    "seconds_per_strain",
    "seconds_to_2_percent",
    "particles",
    "commit",
)
