"""Sealed data: another reality, and what is judged by it."""
