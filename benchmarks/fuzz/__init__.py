"""Mutated inputs for every reader: a million, none of which may end, hang or fool the program."""
