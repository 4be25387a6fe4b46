"""What a rig and a run *are*: the vocabulary that every room shares.

Pure frozen types and pure functions, no input or output. Axes, signs and phases are those of
``docs/conventions.md``; every quantity is in SI units and radians unless its name says otherwise.
"""
