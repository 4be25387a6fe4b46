"""Bodies that swing, and the instruments that watch them: what a model's inertia is measured with.

A test is a chain of the same kind as the towing tank's: release, body, sensors, photogates,
acquisition. :mod:`~sim.pendulum.simulation` builds and runs one and returns the record;
:mod:`~sim.pendulum.body` says what swings; :mod:`~sim.pendulum.effects` holds what a real test
has and an ideal one has not. ``docs/pendulums.md`` is the page about all of it.
"""
