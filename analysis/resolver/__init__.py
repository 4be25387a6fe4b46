"""The harmonic analyser: whole-period gates, exact harmonics, honest intervals.

Use :func:`analysis.resolver.analysis.analyse` for a recording, and the modules below it for a part:
``reference``, ``photocell``, ``signal_reference`` (the phase), ``sums`` (per period), ``estimate``
(harmonics and their uncertainty), ``steady_stretch`` (where to gate), ``checks`` (what to
distrust).
"""
