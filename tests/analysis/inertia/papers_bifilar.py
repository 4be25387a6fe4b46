"""Figures of the bifilar paper (2014) that follow from others of its own."""

import math

from analysis.inertia.beats import beat_period, ratio_from_beats
from analysis.inertia.bifilar import ratio_gyradius, yaw_gyradius, yaw_period
from analysis.inertia.double_pendulum import best_line_length, mode_periods
from analysis.inertia.principal_axes import principal_angle, roll_from_tilts
from tests.analysis.inertia.paper_formulas import (
    average_period,
    gyradius_about,
    gyradius_with_end_masses,
    mass_equivalent_ellipsoid,
    oscillations_per_beat,
)
from tests.analysis.inertia.papers import Figure, Printed

P = Printed

LINE = P(3.477, 1e-3)
HALF = P(0.900, 1e-3)
G = P(9.81, 0.01)
TABLE_1 = (
    (0.0, 4.391, 1056.6),
    (0.0, 4.390, 1056.4),
    (0.0, 4.383, 1054.7),
    (1.2, 4.446, 1069.9),
    (2.4, 4.504, 1083.8),
    (2.4, 4.496, 1082.0),
    (3.6, 4.555, 1096.1),
)
KEEL = {"m": P(306.2, 0.1), "x": P(3141.0, 1.0), "z": P(-934.0, 1.0), "k": P(339.0, 1.0)}
HULL = {"m": P(316.5, 0.1), "x": P(3083.0, 1.0), "z": P(-11.0, 1.0)}
WHOLE = {"m": P(622.7, 0.1), "x": P(3112.0, 1.0), "z": P(-465.0, 1.0)}


def bifilar_figures() -> tuple[Figure, ...]:
    """Return the figures of tables 1 to 4 and of the text."""
    return (*_table_1(), *_table_2(), *_beats(), *_axes(), *_table_4(), *_lines())


def _yaw_mm(period_s: float, half_spacing_m: float, line_m: float, gravity_m_s2: float) -> float:
    return 1e3 * yaw_gyradius(period_s, half_spacing_m, line_m, gravity_m_s2)


def _table_1() -> list[Figure]:
    figures = []
    fixed = {"half_spacing_m": HALF, "line_m": LINE, "gravity_m_s2": G}
    for added, period, printed in TABLE_1:
        inputs = {"period_s": P(period, 1e-3), **fixed}
        what = f"k from T = {period} s ({added} kg added)"
        figures.append(Figure("bifilar 1", what, "mm", P(printed, 0.1), _yaw_mm, inputs))

    def predicted(added_kg: float, forward_m: float) -> float:
        return 1e3 * gyradius_with_end_masses(622.7, 1.056, added_kg, forward_m, 2.717)

    for added, measured in ((1.2, 1069.9), (2.4, 1082.9), (3.6, 1096.1)):
        inputs = {"added_kg": P(added, 0.0), "forward_m": P(3.0905, 5e-3)}
        what = f"k predicted with {added} kg (to 0.2 %)"
        band = P(measured, 0.004 * measured)
        figures.append(Figure("bifilar fig 7", what, "mm", band, predicted, inputs))
    inputs = {"drawn": P(3093.0, 1.0)}
    note = "misprint: 3088 mm in the text, 3093 mm in figure 2; 0.03 % of k at 3.6 kg"
    figures.append(
        Figure(
            "bifilar text", "forward mass", "mm", P(3088.0, 1.0), lambda drawn: drawn, inputs, note
        )
    )
    return figures


def _ratio(yaw_s: float, sway_s: float) -> float:
    return yaw_s / sway_s


def _ratio_mm(yaw_period_s: float, sway_period_s: float, half_spacing_m: float) -> float:
    return 1e3 * ratio_gyradius(yaw_period_s, sway_period_s, half_spacing_m)


def _table_2() -> list[Figure]:
    figures = []
    rows = (
        ("UMS 1", 4.394, 3.802, 1.156, 1040.0, 1057.0),
        ("UMS 4", 4.407, 3.820, 1.154, 1038.0, 1060.0),
    )
    for name, yaw, sway, ratio, by_ratio, by_period in rows:
        both = {"yaw_s": P(yaw, 1e-3), "sway_s": P(sway, 1e-3)}
        figures.append(Figure("bifilar 2", f"{name}: ratio", "1", P(ratio, 1e-3), _ratio, both))
        inputs = {
            "yaw_period_s": both["yaw_s"],
            "sway_period_s": both["sway_s"],
            "half_spacing_m": HALF,
        }
        what = f"{name}: k from the ratio"
        figures.append(Figure("bifilar 2", what, "mm", P(by_ratio, 1.0), _ratio_mm, inputs))
        inputs = {
            "period_s": both["yaw_s"],
            "half_spacing_m": HALF,
            "line_m": LINE,
            "gravity_m_s2": G,
        }
        what = f"{name}: k from the period"
        figures.append(Figure("bifilar 2", what, "mm", P(by_period, 1.0), _yaw_mm, inputs))
    return figures


def _envelope(yaw_s: float, sway_s: float) -> float:
    return 2.0 * beat_period(yaw_s, sway_s)


def _beats() -> list[Figure]:
    both = {"yaw_s": P(4.39, 0.01), "sway_s": P(3.83, 0.01)}
    note = "misprint: the caption's envelope period of 30.0 s is the beat period"
    figures = [
        Figure("bifilar fig 3", "average period", "s", P(4.09, 0.01), average_period, both),
        Figure("bifilar fig 3", "beat period", "s", P(30.0, 0.1), beat_period, both),
        Figure("bifilar fig 3", "envelope period", "s", P(30.0, 0.1), _envelope, both, note),
        Figure("bifilar text", "n per beat", "1", P(7.33, 0.01), oscillations_per_beat, both),
        Figure("bifilar text", "ratio", "1", P(1.146, 1e-3), _ratio, both),
    ]
    for count, printed, last in ((7.5, 1.143, 1e-3), (7.0, 1.154, 1e-3), (25.0, 1.04, 0.01)):
        inputs = {"oscillations": P(count, 0.0)}
        what = f"ratio from n = {count:g}"
        figures.append(
            Figure("bifilar text", what, "1", P(printed, last), ratio_from_beats, inputs)
        )
    return figures


def _axes() -> list[Figure]:
    rows = (("bow down", 294.0, 31.1, -5.50), ("stern down", 290.0, -22.8, -5.54))

    def psi(kr: float, kz: float, kphi: float, phi_deg: float) -> float:
        return math.degrees(principal_angle(kr, kz, kphi, math.radians(phi_deg)))

    figures = []
    for name, tilted, angle, printed in rows:
        inputs = {
            "kr": P(204.0, 1.0),
            "kz": P(310.0, 1.0),
            "kphi": P(tilted, 1.0),
            "phi_deg": P(angle, 0.1),
        }
        what = f"psi, {name} (from the rounded gyradii)"
        figures.append(Figure("bifilar 3", what, "deg", P(printed, 0.01), psi, inputs))

    def roll(kz: float, ka: float, kb: float) -> float:
        return roll_from_tilts(kz, ka, kb, math.radians(31.1), math.radians(-22.8))

    inputs = {"kz": P(310.0, 1.0), "ka": P(294.0, 1.0), "kb": P(290.0, 1.0)}
    figures.append(Figure("bifilar 3", "k roll by eq 25", "mm", P(204.0, 1.0), roll, inputs))
    gyradii = {"px_m": P(0.625, 1e-3), "py_m": P(1.054, 1e-3), "pz_m": P(1.156, 1e-3)}
    for k, (axis, printed) in enumerate((("a", 2.27), ("b", 1.24), ("c", 0.64))):

        def semi_axis(px_m: float, py_m: float, pz_m: float, k: int = k) -> float:
            return mass_equivalent_ellipsoid(px_m, py_m, pz_m)[k]

        what = f"ellipsoid's {axis}, gyradii as printed"
        figures.append(Figure("bifilar fig 1", what, "m", P(printed, 0.01), semi_axis, gyradii))
        if axis != "a":
            swapped = gyradii | {"py_m": gyradii["pz_m"], "pz_m": gyradii["py_m"]}
            note = "misprint: the example swaps k_py and k_pz (pitch is 1.156 m)"
            what = f"ellipsoid's {axis}, pitch and yaw put right"
            figures.append(
                Figure("bifilar fig 1", what, "m", P(printed, 0.01), semi_axis, swapped, note)
            )

    def slope(px: float, pz: float) -> float:
        ahead, behind = (gyradius_about(px, pz, math.radians(3.0 + s)) for s in (0.01, -0.01))
        return (behind - ahead) / 0.02

    inputs = {"px": P(623.0, 1.0), "pz": P(1058.0, 1.0)}
    figures.append(
        Figure("bifilar fig 22", "dk/dphi at 3 deg", "mm/deg", P(0.6, 0.1), slope, inputs)
    )
    return figures


def _weighted(m1: float, v1: float, m2: float, v2: float) -> float:
    return (m1 * v1 + m2 * v2) / (m1 + m2)


def _inertia(m: float, k_mm: float) -> float:
    return m * 1e-6 * k_mm * k_mm


def _table_4() -> list[Figure]:
    masses = {"a": KEEL["m"], "b": HULL["m"]}
    figures = [
        Figure("bifilar 4", "mass", "kg", WHOLE["m"], lambda a, b: a + b, masses),
    ]
    for axis in ("x", "z"):
        inputs = {"m1": KEEL["m"], "v1": KEEL[axis], "m2": HULL["m"], "v2": HULL[axis]}
        what = f"CG {axis} of both"
        figures.append(Figure("bifilar 4", what, "mm", WHOLE[axis], _weighted, inputs))
    rows = (
        ("I pitch, both", WHOLE["m"], 1156.0, 832.0),
        ("I yaw, both", WHOLE["m"], 1057.0, 696.0),
        ("I pitch, hull", HULL["m"], 1448.0, 664.0),
        ("I yaw, hull", HULL["m"], 1459.0, 674.0),
        ("I pitch, keel", KEEL["m"], 339.0, 35.0),
        ("I yaw, keel", KEEL["m"], 263.0, 21.0),
    )
    for what, mass, k, printed in rows:
        inputs = {"m": mass, "k_mm": P(k, 1.0)}
        figures.append(Figure("bifilar 4", what, "kg m2", P(printed, 1.0), _inertia, inputs))
    figures.append(_combined("k pitch of both", 339.0, 1448.0, ("x", "z"), 1156.0))
    figures.append(_combined("k yaw of both", 263.0, 1459.0, ("x",), 1057.0))

    def lean(dx: float, dz: float) -> float:
        return math.degrees(math.atan2(dx, dz))

    inputs = {"dx": P(58.0, 1.0), "dz": P(923.0, 1.0)}
    figures.append(Figure("bifilar text", "lean of hull on keel", "deg", P(3.6, 0.1), lean, inputs))
    return figures


def _combined(what: str, keel: float, hull: float, axes: tuple[str, ...], printed: float) -> Figure:
    def gyradius(m1: float, m2: float, k1: float, k2: float, **apart: float) -> float:
        reduced = m1 * m2 / (m1 + m2)
        square = sum(value * value for value in apart.values())
        return math.sqrt((m1 * k1 * k1 + m2 * k2 * k2 + reduced * square) / (m1 + m2))

    # differences of two printed places: twice the rounding
    apart = {f"d{axis}": P(KEEL[axis].value - HULL[axis].value, 2.0) for axis in axes}
    inputs = {"m1": KEEL["m"], "m2": HULL["m"], "k1": P(keel, 1.0), "k2": P(hull, 1.0), **apart}
    return Figure("bifilar 4", what, "mm", P(printed, 1.0), gyradius, inputs)


def _lines() -> list[Figure]:
    def model(k: float, depth: float) -> float:
        return best_line_length(k, depth, 9.81)

    def keelboat(k: float, ratio: float) -> float:
        return best_line_length(k, k / ratio, 9.81)

    def off(k: float, kp: float, depth: float) -> float:
        slow, _ = mode_periods(kp, depth, 1.560, 9.81)
        return 100.0 * (yaw_period(k, 0.280, 1.560, 9.81) / slow - 1.0)

    small = {"k": P(0.352, 1e-3), "depth": P(0.253, 1e-3)}
    large = {"k": P(1.156, 1e-3), "ratio": P(1.5, 0.1)}
    near = {"k": P(0.303, 1e-3), "kp": P(0.352, 1e-3), "depth": P(0.253, 1e-3)}
    return [
        Figure("bifilar fig 17", "best line, model hull", "m", P(0.5, 0.1), model, small),
        Figure("bifilar fig 17", "best line, keelboat", "m", P(1.7, 0.1), keelboat, large),
        Figure("bifilar fig 15", "T_y over T_1 at 1560 mm, excess", "%", P(0.0, 10.0), off, near),
    ]
