"""Whether this machine can do what the program wants of it, and the cure of what it cannot."""
