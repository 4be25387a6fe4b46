"""The criteria of IMO resolution MSC.137(76), Standards for ship manoeuvrability (2002)."""

ADVANCE, TACTICAL, INITIAL, OVERSHOOT_20 = 4.5, 5.0, 2.5, 25.0


def first_overshoot_deg(length_over_speed_s: float) -> float:
    """Return the limit of the first overshoot of the 10/10 zig-zag, degrees, at full scale."""
    return min(max(5.0 + 0.5 * length_over_speed_s, 10.0), 20.0)


def second_overshoot_deg(length_over_speed_s: float) -> float:
    """Return the limit of the second overshoot of the 10/10 zig-zag, degrees, at full scale."""
    return min(max(17.5 + 0.75 * length_over_speed_s, 25.0), 40.0)
