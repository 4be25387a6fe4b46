"""What ``pmm evaluate`` shows of a campaign's tests: said once, for the terminal and programs."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from analysis.coefficients.exchange import to_dict
from analysis.coefficients.restoring import Restoring
from analysis.coefficients.tows import Tow
from pmm.campaign.calibration import Calibration, as_table
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.notation import degrees, rounded, written
from pmm.evaluation.control_chart import Chart
from pmm.evaluation.evaluation import Evaluation
from pmm.evaluation.rig_tests import GaugeResponse, GaugeZeros, RungMode, TowedSpeed
from pmm.report.circle_table import circle_table
from pmm.report.coefficients_document import conclusion
from pmm.report.conditions import conditions_table
from pmm.report.decays import decay_figure, decay_table
from pmm.report.slow_tests import chart_figure, drift_figure, resistance_figure, restoring_figure

SCHEMA: Final = "pmm-evaluation-1"
_ZEROS: Final[tuple[Column[GaugeZeros], ...]] = (
    word("gauge", "channel"),
    number("first", "first_n", written(".4g"), "N"),
    number("last", "last_n", written(".4g"), "N"),
    number("largest change", "largest_change_n", written(".2g"), "N"),
)
_MODES: Final[tuple[Column[RungMode], ...]] = (
    word("test", "name"),
    Column("f", lambda one: f"{one.frequency_hz:.4g} ± {one.standard_uncertainty_hz:.1g}",
           unit="Hz", number=True),
    *data_only("frequency_hz", "standard_uncertainty_hz"),
    number("damping ratio", "damping_ratio", written(".3g")),
    word("seen on", "channel"),
)  # fmt: skip
_KNOWN_MASS: Final[tuple[Column[GaugeResponse], ...]] = (
    word("run", "run"),
    word("gauge", "channel"),
    number("f", "frequency_hz", written("g"), "Hz"),
    number("gain", "gain", written(".5f")),
    number("lag", "lag_s", lambda lag_s: f"{1e3 * lag_s:.3f}", "ms"),
)

_SPEEDS: Final[tuple[Column[TowedSpeed], ...]] = (
    word("run", "run"),
    number("U asked", "speed_m_s", written("g"), "m/s"),
    number("mean", "mean_m_s", written(".5g"), "m/s"),
    number("off", "off_percent", written("+.2f"), "%"),
    number("standard deviation", "deviation_m_s", written(".2g"), "m/s"),
)


def evaluation_figures(found: Evaluation) -> Iterator[Figure]:
    """Yield the figures of what was tested."""
    water, charts = found.water, found.charts
    if charts:
        yield Figure("control-chart", "The control condition.", lambda: chart_figure(charts))
    if water.restoring:
        yield Figure(
            "restoring",
            "Load of the struts for a displacement.",
            lambda: restoring_figure(water.restoring, water.tracks),
        )
    if water.decays:
        yield Figure("decays", "Heel after release.", lambda: decay_figure(water.decays))
    if (drift := water.derivatives) is not None:
        yield Figure("static-drift", "Loads over drift.", lambda: drift_figure(water.tows, drift))
    if water.straight:
        yield Figure(
            "straight-tow", "Resistance over speed.", lambda: resistance_figure(water.straight)
        )


def evaluation_document(found: Evaluation) -> Document:
    """Return what is shown of the tests; ``docs/run-control.md`` describes the keys."""
    water = found.water
    derivatives = water.derivatives
    told: tuple[Content, ...] = (
        Table("Zeros", _ZEROS, found.zeros, "zeros", titled=True),
        *_calibration(found.calibration),
        Table("Modes", _MODES, found.modes, "modes", titled=True),
        Table("Known mass", _KNOWN_MASS, found.responses, "known_mass", titled=True),
        Table(
            "Carriage, by its own measurement over the gate",
            _SPEEDS,
            found.speeds,
            "carriage",
            titled=True,
        ),
        _restoring(water.restoring),
        Data("restoring", water.restoring),
        _tows(water.tows),
        conditions_table((one.speed_m_s for one in water.tows), water.ship, water.water),
        Data("tows", water.tows),
        circle_table(water.turns),
        decay_table(water.decays),
        *(() if derivatives is None else conclusion(derivatives)),
        Data("derivatives", derivatives and to_dict(derivatives)),
        Text([_verdict(chart) for chart in found.charts]),
        Data("control", found.charts),
        Data("in_control", found.in_control),
        Data("notes", found.notes),
        Data("failed", found.failed),
        Text([str(file) for file in found.files], "files"),
    )
    return Document("", "tests of rig and model", (Section("", told),), SCHEMA)


def _calibration(one: Calibration | None) -> Iterator[Content]:
    yield Data("calibration", None if one is None else as_table(one))
    if one is None:
        return
    columns: tuple[Column[int], ...] = (
        Column("reading", lambda i: one.channels[i]),
        *(
            Column(f"per N on {name}", lambda i, k=k: f"{one.matrix[i][k]:.5f}", number=True)  # type: ignore[misc]
            for k, name in enumerate(one.channels)
        ),
        Column("hysteresis", lambda i: f"{100 * one.hysteresis[i]:.3f}", unit="%", number=True),
        Column("nonlinearity", lambda i: f"{100 * one.nonlinearity[i]:.3f}", unit="%", number=True),
    )
    title = f"Calibration of {one.made}, good until {one.expires}"
    yield Table(title, columns, range(len(one.channels)), titled=True)


def _tows(found: Sequence[Tow]) -> Table[Tow]:
    def load(name: str, key: str, unit: str) -> Column[Tow]:
        def told(one: Tow) -> str:
            return _with_width(getattr(one, key), getattr(one, f"{name}_half_width"))

        return Column(name, told, unit=unit, number=True)

    columns = (
        word("run", "run"),
        number("U", "speed_m_s", written("g"), "m/s"),
        Column[Tow]("drift", lambda one: degrees(one.drift_rad), unit="deg",
                    number=True),
        load("force", "force_n", "N"),
        load("moment", "moment_n_m", "N m"),
        load("resistance", "resistance_n", "N"),
    )  # fmt: skip
    title = "Towed: loads of the water on the model, 95 %"
    return Table(title, columns, found, titled=True, filled=True)


def _restoring(found: Sequence[Restoring]) -> Table[tuple[str, ...]]:
    heads = ("run", "load", "measured", "hydrostatics", "inertia", "bent [%]", "loop [%]")
    columns: tuple[Column[tuple[str, ...]], ...] = tuple(
        Column(head, lambda row, k=k: row[k], number=k > 0)  # type: ignore[misc]
        for k, head in enumerate(heads)
    )
    rows = [row for one in found for row in _restoring_rows(one)]
    title = "Restoring: load of the struts for a displacement, 95 %"
    return Table(title, columns, rows, titled=True, filled=True)


def _restoring_rows(one: Restoring) -> Iterator[tuple[str, ...]]:
    loads = (
        ("force", one.force, one.force_half_width, one.hydrostatic_force, one.force_inertia),
        ("moment", one.moment, one.moment_half_width, one.hydrostatic_moment, one.moment_inertia),
    )
    about = (f"{100.0 * one.higher:.2g}", f"{100.0 * one.loop:.2g}")
    for k, (load, value, width, expected, taken) in enumerate(loads):
        own = load == ("moment" if one.rotates else "force")
        yield (
            "" if k else one.run,
            f"{load} [{one.units[k]}]",
            _with_width(value, width),
            "" if expected is None else f"{expected:.6g}",
            f"{taken:.3g}",
            *(about if own else ("", "")),
        )


def _with_width(value: float, half_width: float) -> str:
    """Return a value with its half-width; empty where there is none."""
    return "" if math.isnan(value) else rounded(value, half_width)


def _verdict(one: Chart) -> str:
    limits = f"{one.centre:.6g} {one.unit}, limits {one.low:.6g} to {one.high:.6g}"
    if one.in_control:
        return f"control {one.quantity}: {limits}; {one.values.size} repeats within them"
    said = [f"{one.runs[i]} is outside ({one.values[i]:.6g})" for i in one.outside]
    if one.step_at is not None:
        before, change = one.step_at
        said.append(f"a step of {change:+.3g} {one.unit} before {one.runs[before]}")
    return f"control {one.quantity}: {limits}; {'; '.join(said)}"
