"""Planar motion mechanism: run tests and analyse their recordings."""
