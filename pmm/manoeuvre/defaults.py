"""What is taken where nobody says: the file beside a campaign, and how many draws."""

from typing import Final

SHIP_FILE: Final = "ship.toml"
DRAWS: Final = 500
"""Half of it moves the ends of a 95 % interval by 10 % of its half, twice costs twice the time."""
