"""The simulator asked for the same, and what is free in every hypothesis."""
