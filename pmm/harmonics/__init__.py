"""Recordings to harmonics: which files are meant, what is asked of them, and what is found."""
