"""Campaigns that choose their runs: after each it is asked again what is known, and what to make.

``course`` asks a goal, shows a change of the plan and waits for approval; ``targets`` is the goal
of coefficients that are to be known, ``growing_plan`` the plan in the campaign's folder, ``look``
what was known and decided after a run, ``approval`` who approves.
"""
