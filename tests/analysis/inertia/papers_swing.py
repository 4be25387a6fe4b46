"""Figures of the swing paper (2021) that follow from others of its own."""

import math
from collections.abc import Callable
from typing import Any

from analysis.inertia.swing import inertia_at_cg, pivot_inertia
from tests.analysis.inertia.papers import Figure, Printed

P = Printed

# name, mass kg, distance below P1 m, inertia about P1 and P2 kg m2
PARTS: tuple[tuple[str, Printed, Printed, Printed, Printed], ...] = (
    ("frame", P(36.568, 1e-3), P(0.165, 1e-3), P(35.423, 1e-3), P(102.540, 1e-3)),
    ("pivot blocks", P(5.345, 1e-3), P(-0.624, 1e-3), P(4.007, 1e-3), P(3.698, 1e-3)),
    ("mass difference", P(0.067, 1e-3), P(0.963, 1e-3), P(0.062, 1e-3), P(0.314, 1e-3)),
    ("inclinometer", P(0.300, 1e-3), P(0.917, 1e-3), P(0.252, 1e-3), P(1.344, 1e-3)),
)
APART_M = P(1.2, 0.0)
G = P(9.81, 0.0)
MASS = P(42.280, 1e-3)

# case: distance by F1 and F2, mm, to 0.1
TABLE_2 = {
    "C1": (69.6, 71.3),
    "C2": (68.6, 71.3),
    "C3": (69.2, 71.2),
    "C4": (1283.9, 1277.4),
    "C5": (1283.9, 1274.9),
    "C6": (1284.9, 1277.7),
}
# case: lever m, largest weight kg, readings, printed offset
OFFSETS = {"C1": (0.2, 1.0, 20, 0.0011), "C2": (0.4, 0.5, 9, 0.0019)}
TABLE_4 = {"C1": (837.6, 100.4), "C2": (829.3, 108.7), "C3": (838.8, 99.3), "C4": (836.6, 101.4)}
PERIODS = {
    "P1": (P(7.3083, 1e-4), P(7.2809, 1e-4), P(7.2878, 1e-4)),
    "P2": (P(2.8455, 1e-4), P(2.8460, 1e-4), P(2.8463, 1e-4)),
}


def swing_figures() -> tuple[Figure, ...]:
    """Return the figures of tables 1 to 4, 7 and 8 and of the text."""
    return (*_table_1(), *_table_2(), *_table_3(), *_table_4(), *_table_7(), *_table_8())


def _mean(**values: float) -> float:
    return sum(values.values()) / len(values)


def _sum(**values: float) -> float:
    return sum(values.values())


def _named(numbers: tuple[Printed, ...]) -> dict[str, Printed]:
    return {f"n{k}": number for k, number in enumerate(numbers)}


def _cg(**given: float) -> float:
    half = len(given) // 2
    pairs = [(given[f"m{k}"], given[f"d{k}"]) for k in range(half)]
    return 1e3 * sum(m * d for m, d in pairs) / sum(m for m, _ in pairs)


def _table_1() -> list[Figure]:
    masses = {f"m{k}": row[1] for k, row in enumerate(PARTS)}
    places = {f"d{k}": row[2] for k, row in enumerate(PARTS)}
    two = {key: value for key, value in (masses | places).items() if key[1] in "01"}
    figures = [
        Figure("swing 1", "total mass", "kg", P(42.280, 1e-3), _sum, masses),
        Figure("swing 3", "CG below P1, all parts", "mm", P(71.9, 0.1), _cg, masses | places),
        Figure(
            "swing 2.1",
            "CG below P1, text",
            "mm",
            P(72.2, 0.1),
            _cg,
            masses | places,
            "misprint, though within what the rounded parts allow: table 3 has 71.9 mm",
        ),
        Figure("swing 2.1", "CG below P1, frame and blocks", "mm", P(64.4, 0.1), _cg, two),
    ]
    about = {"P1": [row[3] for row in PARTS], "P2": [row[4] for row in PARTS]}
    for name, printed in (("P1", 39.745), ("P2", 107.895)):
        inputs = {f"i{k}": number for k, number in enumerate(about[name])}
        figures.append(
            Figure("swing 8", f"theory, I about {name}", "kg m2", P(printed, 1e-3), _sum, inputs)
        )

    def moved(i: float, m: float, d: float, h: float) -> float:
        return i + m * (h * h + 2.0 * h * d)

    for name, m, d, first, second in PARTS:
        inputs = {"i": first, "m": m, "d": d, "h": APART_M}
        figures.append(Figure("swing 1", f"I about P2, {name}", "kg m2", second, moved, inputs))
    return figures


def without_offset(
    distance_mm: float,
    offset: float,
    mass_kg: float,
    lever_m: float,
    most_kg: float,
    readings: float,
) -> float:
    """Distance that F1 gives where F2 gives ``distance_mm`` and a tangent offset.

    For weights spaced evenly up to the largest, as the paper does not say otherwise.
    """
    slope = 1.0 / (mass_kg * 1e-3 * distance_mm)
    slope += offset * 3.0 * readings / ((2.0 * readings + 1.0) * lever_m * most_kg)
    return 1e3 / (mass_kg * slope)


def _table_2() -> list[Figure]:
    figures = []
    for case, (lever, most, count, offset) in OFFSETS.items():
        f1, f2 = TABLE_2[case]
        inputs = {
            "distance_mm": P(f2, 0.1),
            "offset": P(offset, 1e-4),
            "mass_kg": MASS,
            "lever_m": P(lever, 0.0),
            "most_kg": P(most, 0.0),
            "readings": P(float(count), 0.0),
        }
        figures.append(
            Figure(
                "swing 2",
                f"{case}: F1 from F2, offset as a tangent",
                "mm",
                P(f1, 0.1),
                without_offset,
                inputs,
            )
        )
        in_degrees = inputs | {"offset": P(math.radians(offset), math.radians(1e-4))}
        figures.append(
            Figure(
                "swing 2",
                f"{case}: F1 from F2, offset in degrees as printed",
                "mm",
                P(f1, 0.1),
                without_offset,
                in_degrees,
                "misprint: the offset's unit is the tangent (radian), not the degree",
            )
        )
    both = {"c4": P(TABLE_2["C4"][0], 0.1), "c5": P(TABLE_2["C5"][0], 0.1)}
    figures.append(
        Figure(
            "swing 2",
            "C6: F1, C4 and C5 pooled",
            "mm",
            P(TABLE_2["C6"][0], 0.1),
            _mean,
            both,
            "misprint: pooling two series of 1283.9 cannot give 1284.9",
        )
    )
    return figures


def _difference(a: float, b: float) -> float:
    return a - b


def _percent(a: float, b: float) -> float:
    return 100.0 * (a - b) / b


def _table_3() -> list[Figure]:
    figures = []
    printed = {"P1": (69.1, 71.3), "P2": (1284.2, 1276.7)}
    for pivot, cases in (("P1", ("C1", "C2", "C3")), ("P2", ("C4", "C5", "C6"))):
        for k, form in enumerate(("F1", "F2")):
            inputs = _named(tuple(P(TABLE_2[case][k], 0.1) for case in cases))
            mean = P(printed[pivot][k], 0.1)
            figures.append(Figure("swing 3", f"{pivot}: mean of {form}", "mm", mean, _mean, inputs))
    for k, (form, value) in enumerate((("F1", 1215.1), ("F2", 1205.4))):
        inputs = {"a": P(printed["P2"][k], 0.1), "b": P(printed["P1"][k], 0.1)}
        figures.append(
            Figure("swing 3", f"P2 less P1, {form}", "mm", P(value, 0.1), _difference, inputs)
        )
    theory = {"P1": 71.9, "P2": 1271.9}
    for pivot, k, value in (("P1", 0, -3.81), ("P1", 1, -0.82), ("P2", 0, 0.97), ("P2", 1, 0.38)):
        inputs = {"a": P(printed[pivot][k], 0.1), "b": P(theory[pivot], 0.1)}
        what = f"{pivot}: F{k + 1} against theory"
        figures.append(Figure("swing 3", what, "%", P(value, 0.01), _percent, inputs))
    inputs = {"a": P(1205.4, 0.1), "b": P(120.0, 1.0)}
    figures.append(
        Figure(
            "swing 3.3",
            "distance of the pivots against F2, text",
            "%",
            P(0.45, 0.01),
            _percent,
            inputs,
            "misprint: the text says 120 mm, drawing and tables 1200 mm",
        )
    )
    return figures


def _table_4() -> list[Figure]:
    figures = []
    for column, (what, value) in enumerate((("d below P1", 835.6), ("d above bottom", 102.5))):
        inputs = _named(tuple(P(row[column], 0.1) for row in TABLE_4.values()))
        figures.append(Figure("swing 4", f"mean {what}", "mm", P(value, 0.1), _mean, inputs))
    theory = P(100.273, 1e-3)
    for case, percent in (("C1", 0.11), ("C2", 8.42), ("C3", -1.02), ("C4", 1.17)):
        inputs = {"a": P(TABLE_4[case][1], 0.1), "b": theory}
        what = f"{case}: CG height against theory"
        figures.append(Figure("swing 4", what, "%", P(percent, 0.01), _percent, inputs))
    return figures


def _standard_error(**values: float) -> float:
    mean = _mean(**values)
    count = len(values)
    return math.sqrt(sum((v - mean) ** 2 for v in values.values()) / (count - 1) / count)


def _table_7() -> list[Figure]:
    figures = [
        Figure("swing 7", f"{pivot}: mean T by F2", "s", P(value, 1e-4), _mean, _named(runs))
        for (pivot, runs), value in zip(PERIODS.items(), (7.2923, 2.8460), strict=True)
    ]
    runs = _named(PERIODS["P1"])
    figures.append(
        Figure("swing 7", "P1: scatter of the mean", "s", P(0.0082, 1e-4), _standard_error, runs)
    )
    return figures


def _about(formula: Callable[..., Any], t: float, r: float, what: str, value: float) -> Figure:
    inputs = {
        "period_s": P(t, 1e-4),
        "mass_kg": MASS,
        "cg_m": P(r, 1e-4),
        "gravity_m_s2": G,
    }
    return Figure("swing 8", what, "kg m2", P(value, 1e-3), formula, inputs)


def _table_8() -> list[Figure]:
    rows = (("P1", 7.2923, 0.0713, 39.818, 39.603), ("P2", 2.8460, 1.2767, 108.639, 39.726))
    figures = []
    for pivot, t, r, about_pivot, about_cg in rows:
        figures.append(_about(pivot_inertia, t, r, f"{pivot}: I about the pivot", about_pivot))
        figures.append(_about(inertia_at_cg, t, r, f"{pivot}: I about the CG", about_cg))

    def to_pivot(i: float, m: float, r: float) -> float:
        return i + m * r * r

    moves = (
        ("I about P2, from P1", 39.603, 1.2767, 108.517),
        ("I about P1, from P2", 39.726, 0.0713, 39.941),
    )
    for what, i, r, value in moves:
        inputs = {"i": P(i, 1e-3), "m": MASS, "r": P(r, 1e-4)}
        figures.append(Figure("swing 8", what, "kg m2", P(value, 1e-3), to_pivot, inputs))
    excess = (
        ("P1 by P1", 39.818, 39.745, 0.073, 0.18),
        ("P2 by P1", 108.517, 107.895, 0.622, 0.58),
        ("P1 by P2", 39.941, 39.745, 0.196, 0.49),
        ("P2 by P2", 108.639, 107.895, 0.745, 0.69),
    )
    for what, a, b, value, percent in excess:
        inputs = {"a": P(a, 1e-3), "b": P(b, 1e-3)}
        kg = P(value, 1e-3)
        figures.append(Figure("swing 8", f"{what} less theory", "kg m2", kg, _difference, inputs))
        share = P(percent, 0.01)
        figures.append(Figure("swing 8", f"{what} against theory", "%", share, _percent, inputs))
    rounded = _about(pivot_inertia, 7.2923, 0.071, "P1: I about the pivot, R as printed", 39.818)
    exact = {**rounded.inputs, "cg_m": P(0.071, 0.0)}
    note = "R is printed rounded to 0.071; 0.0713 was used"
    figures.append(
        Figure("swing 8", rounded.what, "kg m2", rounded.printed, pivot_inertia, exact, note)
    )
    return figures
