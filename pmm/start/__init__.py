"""First files: what ``pmm init`` writes, so that a user begins from something that runs.

Templates are commented TOML; what is written has been read by the very readers that will use it.
"""
