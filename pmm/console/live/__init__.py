"""Live values for others who read along: one table of values, and an outlet for each protocol.

The web server hands what the loop tells to :mod:`~pmm.console.live.process`, in a process of its
own, so that no reader holds up the server. There :mod:`~pmm.console.live.values` makes a table of
each tick, which every :class:`~pmm.console.live.outlet.Outlet` carries out. Nothing is ever read
from outside. ``docs/live-values.md`` has the names and units.
"""
