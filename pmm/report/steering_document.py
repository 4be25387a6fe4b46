"""What ``pmm steering`` shows: parameters, self-propulsion, wakes, the tows, and a picture."""

import math
from collections.abc import Iterator
from operator import attrgetter
from pathlib import Path
from statistics import NormalDist
from typing import Any, Final, NamedTuple

import numpy as np

from analysis.steering.propulsion import SelfPropulsion
from hardware.description.errors import PmmError
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.flag_lines import flag_notes
from pmm.document.notation import between, degrees, rounded, written
from pmm.report.conditions import NOTE, condition_columns
from pmm.report.steering_figure import steering_figure
from pmm.steering.plausibility import doubts
from pmm.steering.reading import SteeredRun
from pmm.steering.settings import SETTINGS_FILE
from pmm.steering.workflow import CampaignSteering, steering_of

SCHEMA: Final = "pmm-steering-1"
_MEANS: Final = {
    "1-t_P": "thrust deduction factor",
    "w_P0": "wake fraction on straight course",
    "t_R": "steering resistance deduction",
    "a_H": "increase of the rudder's lateral force",
    "x_H'": "place of that increase, over L",
    "epsilon": "wake ratio of rudder and propeller",
    "kappa": "acceleration by the propeller",
    "gamma_R+": "flow straightening, bow to starboard",
    "gamma_R-": "flow straightening, bow to port",
    "l_R'": "lever of the inflow in a turn, over L",
    "delta_0": "neutral rudder angle, rad",
}
_MISFIT: Final = 2.0


class _Parameter(NamedTuple):
    name: str
    value: float
    standard_uncertainty: float
    low: float
    high: float


class _Wake(NamedTuple):
    speed_m_s: float
    drift_deg: float
    turning_rad_s: float
    wake: float
    standard_uncertainty: float


def steering_document(steering: CampaignSteering, level: float) -> Document:
    """Return what was identified; ``docs/steering.md`` has the keys."""
    figures = Section("Figures", tuple(steering_figures(steering)))
    content = Section("", _contents(steering, level))
    return Document(steering.name, "propeller and rudder", (content, figures), SCHEMA)


def steering_story(folder: Path, level: float) -> Iterator[Section]:
    """Yield a report's section on propeller and rudder of a campaign that has ``steering.toml``."""
    if not (folder / SETTINGS_FILE).exists():
        return
    try:
        steering = steering_of(folder)
    except PmmError as error:
        yield Section("Propeller and rudder", (Notes([Note("warning", str(error))]),))
        return
    failed = Notes([Note("warning", failure.message) for failure in steering.failed])
    contents = (*_contents(steering, level), failed, *steering_figures(steering))
    yield Section("Propeller and rudder", contents)


def _contents(steering: CampaignSteering, level: float) -> tuple[Content, ...]:
    parameters, factor = steering.parameters, NormalDist().inv_cdf(0.5 + 0.5 * level)
    rows = [
        _Parameter(name, value, u, value - factor * u, value + factor * u)
        for name, value, u in zip(
            parameters.names,
            parameters.values.tolist(),
            parameters.standard_uncertainty.tolist(),
            strict=True,
        )
    ]
    return (
        _parameters(rows, level),
        Notes(
            [
                Note("doubt", doubt)
                for doubt in doubts(parameters, steering.runs, steering.particulars)
            ],
            "doubts",
        ),
        Notes(
            [Note("missing", f"{_plain(key)}: {how}") for key, how in parameters.missing.items()]
        ),
        Data("missing", parameters.missing),
        Data("covariance", parameters.covariance.tolist()),
        Text(list(_fit(steering))),
        Data("misfit", dict(zip(("loads", "inflow"), parameters.misfit, strict=True))),
        _propulsion(steering, factor),
        _wakes(steering, factor),
        _tows(steering, factor),
        Data("failed", [failure.message for failure in steering.failed]),
        Notes(flag_notes(steering.left_out)),
        Data("left_out", steering.left_out),
    )


def steering_figures(steering: CampaignSteering) -> Iterator[Figure]:
    """Yield the figures."""
    caption = (
        "Left: the rudder's normal force over its angle, with the fit. Right: force along the "
        "model over thrust on straight course, the rudder amidships; its slope is 1 - t_P."
    )
    yield Figure("steering", caption, lambda: steering_figure(steering))


def _plain(name: str) -> str:
    return f"{name} is not told by these runs; it takes"


def _parameters(rows: list[_Parameter], level: float) -> Table[_Parameter]:
    columns: tuple[Column[_Parameter], ...] = (
        word("parameter", "name"),
        Column("", lambda row: _MEANS[row.name]),
        number("value", "value", written(".4g")),
        number("u", "standard_uncertainty", written(".2g")),
        Column(
            f"{100.0 * level:g} % interval",
            lambda row: between(row.low, row.high),
            number=True,
        ),
        *data_only("low", "high"),
    )
    return Table("Propeller and rudder", columns, rows, "parameters", titled=True)


def _fit(steering: CampaignSteering) -> Iterator[str]:
    loads, inflow = steering.parameters.misfit
    yield (
        f"residuals over their stated scatter: {loads:.3g} for the loads, {inflow:.3g} for thrust "
        "and normal force"
        + (
            ": beyond 2 the MMG method's form is not this ship's, or the scatter is more than the "
            "runs' own; intervals are wider by it"
            if max(loads, inflow) > _MISFIT
            else ""
        )
    )


def _propulsion(steering: CampaignSteering, factor: float) -> Table[SelfPropulsion]:
    def value_column(heading: str, key: str, unit: str, u: str) -> Column[SelfPropulsion]:
        return Column(
            heading,
            lambda point: rounded(getattr(point, key), factor * getattr(point, u)),
            unit=unit,
            number=True,
        )

    columns: tuple[Column[SelfPropulsion], ...] = (
        number("U", "speed_m_s", written("g"), "m/s"),
        value_column("resistance", "resistance_n", "N", "resistance_u"),
        value_column("thrust", "thrust_n", "N", "thrust_u"),
        value_column("revolutions", "rate_hz", "1/s", "rate_u"),
        number("J", "advance", written(".4g")),
        *_conditions(steering),
        *data_only("resistance_n", "resistance_u", "thrust_n", "thrust_u", "rate_hz", "rate_u"),
    )
    rows = steering.parameters.self_propulsion
    return Table(
        "Self-propulsion point", columns, rows, "self_propulsion", titled=True, filled=True,
        notes=(NOTE,),
    )  # fmt: skip


def _conditions(steering: CampaignSteering) -> Iterator[Column[Any]]:
    return condition_columns(attrgetter("speed_m_s"), steering.settings.length_m, steering.water)


def _wakes(steering: CampaignSteering, factor: float) -> Table[_Wake]:
    u, v, r, wake, spread = steering.parameters.wakes
    rows = [
        _Wake(*values)
        for values in np.stack(
            (np.hypot(u, v), np.round(np.degrees(np.arctan2(-v, u)), 9), r, wake, spread), axis=1
        ).tolist()
    ]
    columns: tuple[Column[_Wake], ...] = (
        number("U", "speed_m_s", written(".4g"), "m/s"),
        number("drift", "drift_deg", written("z.3g"), "deg"),
        number("r", "turning_rad_s", written(".3g"), "rad/s"),
        Column("w_P", lambda row: rounded(row.wake, factor * row.standard_uncertainty),
               number=True),
        *_conditions(steering),
        *data_only("wake", "standard_uncertainty"),
    )  # fmt: skip
    return Table("Wake by thrust identity", columns, rows, "wakes", titled=True, filled=True)


def _tows(steering: CampaignSteering, factor: float) -> Table[SteeredRun]:
    def load(heading: str, row: int, unit: str) -> Column[SteeredRun]:
        return Column(
            heading,
            lambda run: rounded(run.loads[row], factor * run.loads_u[row]),
            unit=unit,
            number=True,
        )

    def unit(run: SteeredRun) -> float:
        """Return rho n² D⁵, by which a torque becomes K_Q."""
        return (
            steering.particulars.density_kg_m3 * run.rate_hz**2 * steering.particulars.diameter_m**5
        )

    columns: tuple[Column[SteeredRun], ...] = (
        word("run", "run"),
        Column("drift", lambda run: degrees(run.drift_rad), unit="deg",
               number=True),
        Column("r", lambda run: f"{run.motion[2]:.3g}", unit="rad/s", number=True),
        Column("rudder", lambda run: degrees(run.rudder_rad), unit="deg",
               number=True),
        number("n", "rate_hz", written(".4g"), "1/s"),
        load("X", 0, "N"),
        load("Y", 1, "N"),
        load("N", 2, "N m"),
        Column("thrust", lambda run: rounded(run.thrust_n, factor * run.thrust_u), unit="N",
               number=True),
        Column("F_N", lambda run: rounded(run.normal_n, factor * run.normal_u), unit="N",
               number=True),
        Column("Q", lambda run: _if_read(run, rounded(run.torque_n_m, factor * run.torque_u)),
               unit="N m", number=True),
        Column("10 K_Q", lambda run: _if_read(run, f"{10.0 * run.torque_n_m / unit(run):.4g}"),
               number=True),
        *data_only("motion", "loads", "loads_u", "rudder_rad", "thrust_n", "thrust_u", "normal_n",
                   "normal_u", "torque_n_m", "torque_u"),
    )  # fmt: skip
    return Table(
        "Runs with propeller and rudder", columns, steering.tows, "tows", titled=True, folded=True,
        filled=True,
    )  # fmt: skip


def _if_read(run: SteeredRun, text: str) -> str:
    return text if math.isfinite(run.torque_n_m) else ""
