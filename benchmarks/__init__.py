"""Speed, accuracy and honesty, measured against named rivals: ``python -m benchmarks``."""
