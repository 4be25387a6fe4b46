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
    word("state", "state"),
    number("first", "first_n", written(".4g"), "N"),
    number("last", "last_n", written(".4g"), "N"),
    number("largest change", "largest_change_n", written(".2g"), "N"),
)
_MODES: Final[tuple[Column[RungMode], ...]] = (
    word("test", "name"),
    Column("f", lambda mode: f"{mode.frequency_hz:.4g} ± {mode.standard_uncertainty_hz:.1g}",
           unit="Hz", number=True),
    *data_only("frequency_hz", "standard_uncertainty_hz"),
    number("damping ratio", "damping_ratio", written(".3g")),
    word("seen on", "channel"),
)  # fmt: skip
_KNOWN_MASS: Final[tuple[Column[GaugeResponse], ...]] = (
    word("run", "run"),
    word("gauge", "channel"),
    number("f", "frequency_hz", written("g"), "Hz"),
    Column("gain", lambda found: rounded(found.gain, found.gain_half_width), number=True),
    Column(
        "lag",
        lambda found: rounded(1e3 * found.lag_s, 1e3 * found.lag_half_width_s),
        unit="ms",
        number=True,
    ),
    *data_only("gain", "gain_half_width", "lag_s", "lag_half_width_s"),
)

_SPEEDS: Final[tuple[Column[TowedSpeed], ...]] = (
    word("run", "run"),
    number("U asked", "speed_m_s", written("g"), "m/s"),
    number("mean", "mean_m_s", written(".5g"), "m/s"),
    number("off", "off_percent", written("+.2f"), "%"),
    number("standard deviation", "deviation_m_s", written(".2g"), "m/s"),
)


def evaluation_figures(evaluation: Evaluation) -> Iterator[Figure]:
    """Yield the figures of what was tested."""
    water, charts = evaluation.water, evaluation.charts
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


def evaluation_document(evaluation: Evaluation) -> Document:
    """Return what is shown of the tests; ``docs/run-control.md`` describes the keys."""
    water = evaluation.water
    derivatives = water.derivatives
    contents: tuple[Content, ...] = (
        Table("Zeros", _ZEROS, evaluation.zeros, "zeros", titled=True),
        *_calibration(evaluation.calibration),
        Table("Modes", _MODES, evaluation.modes, "modes", titled=True),
        Table("Known mass, 95 %", _KNOWN_MASS, evaluation.responses, "known_mass", titled=True),
        Table(
            "Carriage, by its own measurement over the gate",
            _SPEEDS,
            evaluation.speeds,
            "carriage",
            titled=True,
        ),
        _restoring(water.restoring),
        Data("restoring", water.restoring),
        _tows(water.tows),
        conditions_table((tow.speed_m_s for tow in water.tows), water.ship, water.water),
        Data("tows", water.tows),
        circle_table(water.turns),
        decay_table(water.decays),
        *(() if derivatives is None else conclusion(derivatives)),
        Data("derivatives", derivatives and to_dict(derivatives)),
        Text([_verdict(chart) for chart in evaluation.charts]),
        Data("control", evaluation.charts),
        Data("in_control", evaluation.in_control),
        Data("notes", evaluation.notes),
        Data("failed", evaluation.failed),
        Text([str(file) for file in evaluation.files], "files"),
    )
    return Document("", "tests of rig and model", (Section("", contents),), SCHEMA)


def _calibration(calibration: Calibration | None) -> Iterator[Content]:
    yield Data("calibration", None if calibration is None else as_table(calibration))
    if calibration is None:
        return
    columns: tuple[Column[int], ...] = (
        Column("reading", lambda i: calibration.channels[i]),
        *(
            Column(
                f"per N on {name}",
                lambda i, k=k: f"{calibration.matrix[i][k]:.5f}",  # type: ignore[misc]
                number=True,
            )
            for k, name in enumerate(calibration.channels)
        ),
        Column(
            "hysteresis", lambda i: f"{100 * calibration.hysteresis[i]:.3f}", unit="%", number=True
        ),
        Column(
            "nonlinearity",
            lambda i: f"{100 * calibration.nonlinearity[i]:.3f}",
            unit="%",
            number=True,
        ),
    )
    title = f"Calibration of {calibration.made}, good until {calibration.expires}"
    yield Table(title, columns, range(len(calibration.channels)), titled=True)


def _tows(tows: Sequence[Tow]) -> Table[Tow]:
    def load(name: str, key: str, unit: str) -> Column[Tow]:
        def value_text(tow: Tow) -> str:
            return _with_width(getattr(tow, key), getattr(tow, f"{name}_half_width"))

        return Column(name, value_text, unit=unit, number=True)

    columns = (
        word("run", "run"),
        number("U", "speed_m_s", written("g"), "m/s"),
        Column[Tow]("drift", lambda tow: degrees(tow.drift_rad), unit="deg",
                    number=True),
        load("force", "force_n", "N"),
        load("moment", "moment_n_m", "N m"),
        load("resistance", "resistance_n", "N"),
    )  # fmt: skip
    title = "Towed: loads of the water on the model, 95 %"
    return Table(title, columns, tows, titled=True, filled=True)


def _restoring(tests: Sequence[Restoring]) -> Table[tuple[str, ...]]:
    heads = ("run", "load", "measured", "hydrostatics", "inertia", "bent [%]", "loop [%]")
    columns: tuple[Column[tuple[str, ...]], ...] = tuple(
        Column(head, lambda row, k=k: row[k], number=k > 0)  # type: ignore[misc]
        for k, head in enumerate(heads)
    )
    rows = [row for test in tests for row in _restoring_rows(test)]
    title = "Restoring: load of the struts for a displacement, 95 %"
    return Table(title, columns, rows, titled=True, filled=True)


def _restoring_rows(test: Restoring) -> Iterator[tuple[str, ...]]:
    loads = (
        ("force", test.force, test.force_half_width, test.hydrostatic_force, test.force_inertia),
        (
            "moment",
            test.moment,
            test.moment_half_width,
            test.hydrostatic_moment,
            test.moment_inertia,
        ),
    )
    about = (f"{100.0 * test.higher:.2g}", f"{100.0 * test.loop:.2g}")
    for k, (load, value, width, expected, inertia) in enumerate(loads):
        is_main_load = load == ("moment" if test.rotates else "force")
        yield (
            "" if k else test.run,
            f"{load} [{test.units[k]}]",
            _with_width(value, width),
            "" if expected is None else f"{expected:.6g}",
            f"{inertia:.3g}",
            *(about if is_main_load else ("", "")),
        )


def _with_width(value: float, half_width: float) -> str:
    """Return a value with its half-width; empty where there is none."""
    return "" if math.isnan(value) else rounded(value, half_width)


def _verdict(chart: Chart) -> str:
    limits = f"{chart.centre:.6g} {chart.unit}, limits {chart.low:.6g} to {chart.high:.6g}"
    if chart.in_control:
        return f"control {chart.quantity}: {limits}; {chart.values.size} repeats within them"
    words = [f"{chart.runs[i]} is outside ({chart.values[i]:.6g})" for i in chart.outside]
    if chart.step_at is not None:
        before, change = chart.step_at
        words.append(f"a step of {change:+.3g} {chart.unit} before {chart.runs[before]}")
    return f"control {chart.quantity}: {limits}; {'; '.join(words)}"
