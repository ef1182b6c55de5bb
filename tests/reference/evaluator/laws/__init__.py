"""One function for each law. Sources as in engine/PHYSICS.md: L is Li, Royer & Ness (2023), M is Monti et al. (2021).

A law of pairs takes Pairs and its own parameters, and returns the force on i; with it, where it has torques, those on i
and on j. The force on j is the opposite one.
"""
