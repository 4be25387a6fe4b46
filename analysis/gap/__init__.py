"""Where simulation and rig differ, which unmodelled effect causes it, and how far it shrinks.

The rooms are the theory, each built on those before it: :mod:`inference` is the one equation,
:mod:`observe` turns recordings into observations, :mod:`forward` asks the simulator for the same,
:mod:`quality` says which recordings cannot be right, :mod:`locate` walks along the chain,
:mod:`search` weighs what could explain the difference, :mod:`design` chooses the next run, and
:mod:`judge` says what it all means; :mod:`pendulum` is the same for pendulum tests and decays.
``docs/gap-theory.md`` has the method.
"""
