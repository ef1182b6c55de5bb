"""Forces, torques and stresses of single configurations, written apart from the engine.

    geometry         the sheared cell, and pairs of particles in it
    laws             one function for each law
    evaluation       which laws a scene has, and what they make of a configuration
    configurations   configurations at random

Documents are those of `peclet-engine forces` (schema/README.md).
"""
