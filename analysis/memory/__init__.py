"""The water's memory from coefficients that were measured at several frequencies.

``measured`` picks added mass and damping of the model at rest out of a campaign's table; ``fit``
finds the state space that describes them (``result``); ``table`` writes it for a simulation. The
partial fractions are the simulator's numerics (:mod:`sim.model.water.vector_fitting`), because what
is found is what the simulator takes.
"""
