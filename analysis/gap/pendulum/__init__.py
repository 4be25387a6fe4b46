"""The gap between a pendulum test, or a free decay, and its simulation.

The idea is that of the campaigns (:mod:`analysis.gap.inference.gaussian`): each effect acts where
it physically acts, in :mod:`sim.pendulum`; the release and what is known within tolerances are
free; the evidence decides. Start at :func:`analysis.gap.pendulum.diagnose.diagnose_trials`.
"""
