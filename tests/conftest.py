"""What holds for every test: property tests draw the same examples each time."""

from hypothesis import settings

settings.register_profile("seeded", derandomize=True)
settings.load_profile("seeded")
