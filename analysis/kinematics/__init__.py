"""Exact motion and loads in body axes, at any angle and for every arrangement of the rig.

``cycle``: harmonics of a run's channels over the averaged cycle, and back. ``motion``: from the
struts' displacements to u, v (w), r (q) and their rates. ``projection``: from gauge readings to
loads and back. ``rigid_body``: inertia and weight of the model. ``complex_step``: the slope of any
of it, for covariances. All of it works on arrays of instants, for many runs and trials at once.
"""
