"""Inertia jobs: a small TOML names records and geometry, and becomes mass properties.

:mod:`~pmm.inertia.reading` reads and checks the file, :mod:`~pmm.inertia.sources` turns records,
light gates and stopwatches into periods, a module for each job runs :mod:`analysis.inertia`, and
:mod:`~pmm.inertia.outcome` is what all of them end in. ``docs/inertia-files.md`` has the keys.
"""
