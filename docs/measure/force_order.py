"""The nematic order of forces between pairs: how well their lines agree, and at which angle they lie.

Q = <3 f f - 1> / 2, with f the direction of a force; each pair counts as much as its force is large. The order is the
largest eigenvalue: 0 for lines in all directions, 1 if they are parallel. The angle is that of its axis in the plane of
shear, from the flow, between -90 and 90 degrees.
"""

import numpy as np

quantities = {"force_order": {"symbol": "S"}, "force_angle": {"symbol": "θ", "unit": "degree"}}


def measure(frame):
    force = frame.pairs.force
    size = np.linalg.norm(force, axis=1)
    force, size = force[size > 0], size[size > 0]
    if len(force) == 0:
        return {"force_order": None, "force_angle": None}
    tensor = np.einsum("p,pi,pj->ij", 1 / size, force, force) / size.sum()
    orders, axes = np.linalg.eigh(1.5 * tensor - 0.5 * np.eye(3))
    x, y, _ = axes[:, -1]  # the axis of the largest one
    return {"force_order": orders[-1], "force_angle": np.degrees(np.arctan(y / x)) if x else 90}
