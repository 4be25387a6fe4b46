"""Recordings in, numbers out."""
