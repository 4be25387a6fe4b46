"""Mass, centre of gravity and moments of inertia of a model, from the raw record of any pendulum.

The way of the data: a record (:mod:`~analysis.inertia.series`, :mod:`~analysis.inertia.gates`,
:mod:`~analysis.inertia.stopwatch`) becomes periods (:mod:`~analysis.inertia.damped_fit`,
:mod:`~analysis.inertia.amplitude`), repeated runs become one period with the scatter between them
(:mod:`~analysis.inertia.repeats`), periods and lengths become inertia by the formulas of
:mod:`~analysis.inertia.swing`, :mod:`~analysis.inertia.bifilar` and their relatives, each with a
budget (:mod:`~analysis.uncertainty.budget`), and end in :mod:`~analysis.inertia.result`.
"""
