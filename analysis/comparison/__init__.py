"""Two channels that show the same: gain, lag, clock rate and dead band of one over the other.

:func:`analysis.comparison.compare.compare` does it; ``docs/comparison.md`` says how.
"""
