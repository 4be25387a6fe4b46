"""Recordings in, everything that a diagnosis compares out."""
