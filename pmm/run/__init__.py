"""Run control: carries out a plan on a rig, cycle by cycle, and records it.

:class:`pmm.run.run_control.RunControl` is the whole of it; a terminal view or a console drives it
by its ``step`` and ``request``. Nothing here knows the simulator.
"""
