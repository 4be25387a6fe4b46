"""An exact rig by its own means: the oracle for kinematics at any angle.

It shares no code with ``sim/`` or ``analysis/`` but the vocabulary. Points of the rig are complex
numbers (ahead + i across), differentiated with :class:`~tests.exact.jet.Jet`; the body obeys Newton
and Euler about its centre of gravity in the tank's frame; the joint's forces solve its equilibrium;
gauges read what points their way. ``test_energy_against_work.py`` holds it to account.
"""
