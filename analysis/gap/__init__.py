"""Where simulation and rig differ, which unmodelled effect causes it, and how far it shrinks.

:mod:`analysis.gap.observe` turns recordings into observations and :mod:`analysis.gap.forward` asks
the simulator for the same; :mod:`analysis.gap.hypotheses` weighs what could explain the difference;
:mod:`analysis.gap.diagnose` does all of it for a campaign. ``docs/gap-theory.md`` has the method.
"""
