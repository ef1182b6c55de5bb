"""Forces, torques and stresses of single configurations, written independently of the engine.

    geometry         the sheared cell, and pairs of particles in it
    laws             one function for each law
    evaluation       the laws of a scene, and their forces on a configuration
    configurations   random configurations

Documents are those of `peclet-engine forces` (schema/README.md).
"""
