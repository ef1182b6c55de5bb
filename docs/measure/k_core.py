"""The k-core of the contacts: the spheres that are left if all with fewer than k contacts are removed, repeatedly."""

import numpy as np

largest = 6
quantities = {"k_core": {"symbol": "n_k / N", "axes": [{"name": "k", "values": range(1, largest + 1)}]}}


def measure(frame):
    left, touch = np.ones(frame.count, bool), frame.contacts
    shares = []
    for k in range(1, largest + 1):
        while True:
            touch = touch[left[touch.first] & left[touch.second]]
            contacts = np.bincount(np.append(touch.first, touch.second), minlength=frame.count)
            if not (left & (contacts < k)).any():
                break
            left &= contacts >= k
        shares.append(left.mean())
    return {"k_core": shares}
