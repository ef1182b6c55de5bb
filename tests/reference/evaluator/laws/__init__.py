"""One function for each law. Sources: L is Li, Royer & Ness (2023), M is Monti et al. (2021).

A pair law takes Pairs and its own parameters. It returns the force on i, and for laws with torques those on i
and j. The force on j is opposite.
"""
