"""The operator's console: a page in a browser that shows a rig and commands it.

Two processes. :mod:`~pmm.console.station` runs the rig's loop and knows nothing of browsers;
:mod:`~pmm.console.session` serves the page and knows nothing of devices. Between them lies
:mod:`~pmm.console.link`, which never makes the loop wait. ``docs/console.md`` has the way of the
data and the rules of safety.
"""
