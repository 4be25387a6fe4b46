"""The form of a remainder in sentences."""

import math
from collections.abc import Sequence

from analysis.gap.description import Description


def described(one: Description | None) -> Sequence[str]:
    """Return the description of a remainder, a sentence each; it names no cause."""
    if one is None:
        return ()
    orders = sorted(one.orders.items(), key=lambda pair: -pair[1])[:3]
    lines = [
        "its form, not its cause: harmonics "
        + ", ".join(f"{n} ({100.0 * share:.0f} %)" for n, share in orders),
        "a curve over one quantity carries "
        + ", ".join(f"{100.0 * share:z.0f} % ({name})" for name, share in one.follows.items()),
    ]
    laws = [("frequency", one.frequency_power), ("amplitude", one.amplitude_power)]
    powers = [f"{name}^{power:z.1f}" for name, power in laws if math.isfinite(power)]
    if powers:
        lines.append(f"it grows as {', '.join(powers)}")
    if math.isfinite(one.air_over_water):
        lines.append(f"in air it is {one.air_over_water:.2f} times as large as in water")
    if one.law.terms:
        terms = ", ".join(f"{channel}: {n:+.3g} N {term}" for channel, term, n in one.law.terms)
        lines.append(f"few terms that carry {100.0 * one.law.explained:.0f} % of it: {terms}")
    return lines
