"""The catalogue: what separates a real rig from an ideal one, one small file each.

:mod:`sim.effects.effect` says what an effect is, :mod:`sim.effects.catalogue` finds them all and
builds them by name, :mod:`sim.effects.situation` holds what a signature may depend on.
"""
