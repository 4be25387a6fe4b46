"""A campaign's files: what they say of rig, model and runs, and the one door to a recording."""
