"""Motions of many lines: their design, the frequency response that they tell, and distortions."""
