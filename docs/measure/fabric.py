"""The fabric tensor <n n> of contacts, with n the direction from centre to centre."""

import numpy as np

quantities = {"fabric": {"symbol": "⟨n n⟩", "axes": [{"name": "component", "values": "xx yy zz xy xz yz".split()}]}}


def measure(frame):
    n = frame.contacts.normal
    if len(n) == 0:
        return {"fabric": None}  # this frame has no value
    tensor = np.einsum("ci,cj->ij", n, n) / len(n)
    return {"fabric": tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]}
