"""Whole inertia tests on simulated records, from the sensors' samples to an interval.

The simulator (:mod:`sim.pendulum`) knows bodies and sensors and nothing of the analysis. Each
campaign draws what an experimenter cannot know: how far the lines, levers and masses are from what
the tape and the scale say, and how much each release differs from the last.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.random import Generator

from analysis.inertia.bifilar import sway_period, yaw_gyradius, yaw_period
from analysis.inertia.double_pendulum import PendulumResult, pitch_from_periods
from analysis.inertia.lengthening import pendulum_lengthening
from analysis.inertia.record import RecordAnalysis, analyse_record, from_runs
from analysis.inertia.series import Series, series_from_recording
from analysis.inertia.swing import model_gyradius
from analysis.inertia.swing_static import LeverSeries, fit_static
from analysis.readers.dataset import from_dataset
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.pendulum.benches import KEELBOAT_2014, SWING_2021
from sim.pendulum.effects import make_effect
from sim.pendulum.pivot import RigidPart
from sim.pendulum.sensors import INCLINOMETER_RANGE_RAD
from sim.pendulum.simulation import (
    simulate_bifilar,
    simulate_double_pendulum,
    simulate_swing,
    simulate_swing_static,
)
from sim.pendulum.suspension import Suspension

if TYPE_CHECKING:
    from sim.pendulum.bench import PendulumBench
    from sim.pendulum.effects.base import PendulumEffect
    from sim.pendulum.record import PendulumRecord

G = exactly(STANDARD_GRAVITY_M_S2, "m/s2")
HULL = KEELBOAT_2014
MODEL = RigidPart(mass_kg=30.0, lever_m=0.8, inertia_kg_m2=10.8)  # gyradius 0.6 m
RUNS, SWINGS = 4, 30.0
TILTS_RAD = np.arctan(np.linspace(0.0, 0.04, 6))  # up to 2.3 degrees, of the inclinometer's three

# Standard deviations of what is not known: tape, scale, and a release against the next.
TAPE_M = 5e-4
LINE_M = 2e-3
SCALE_KG = 5e-3
LEVER_RELATIVE = 1e-3
RELEASE = 3e-4  # of the period
BOW = 5e-4  # the inclinometer's largest non-linearity, over twice its range
ZERO = 2e-4  # the same of its zero from one reading to the next


@dataclass(frozen=True)
class Campaign:
    """What one campaign gave.

    Attributes
    ----------
    found, truth
        The quantity with its uncertainty, and what the simulator had.
    ideal
        Its standard uncertainty were all inputs' known, by the same formula.
    """

    found: Estimate
    truth: float
    ideal: float

    @property
    def covered(self) -> bool:
        """Whether the interval of 95 % holds the truth."""
        low, high = self.found.interval()
        return low <= self.truth <= high

    @property
    def width(self) -> float:
        """The interval over the one of the ideal uncertainty."""
        low, high = self.found.interval()
        return (high - low) / (2.0 * 1.96 * self.ideal)


def series_of(record: "PendulumRecord", channel: str) -> Series:
    """Take a channel of a simulated record as the analysis reads it."""
    return series_from_recording(from_dataset(record.dataset), channel)


def losses(*coordinates: str) -> "list[PendulumEffect]":
    """Return dry friction, quadratic drag and viscous damping on each coordinate."""
    return [
        effect
        for one in coordinates
        for effect in (
            make_effect("bearing_friction", coordinate=one, dead_zone=2e-5),
            make_effect("quadratic_drag", coordinate=one, loss=0.1),
            make_effect("viscous_damping", coordinate=one, damping_ratio=1.5e-3),
        )
    ]


def instruments(offset: float, noise_rms: float) -> "list[PendulumEffect]":
    """Return an offset and noise of all sensors."""
    return [
        make_effect("sensor_offset", offset=offset),
        make_effect("sensor_noise", noise_rms=noise_rms),
    ]


def release(generator: Generator) -> "dict[str, Any]":
    """Return a seed, and the effect that makes this release's period a little its own."""
    own = make_effect("wrong_clock", clock_error=RELEASE * generator.standard_normal())
    return {"seed": int(generator.integers(2**31)), "effects": [own]}


def bifilar_run(body: Suspension, seed: int, effects: "list[PendulumEffect]") -> RecordAnalysis:
    """Return one yaw record, range finder at the stern, with sway in it."""
    period = yaw_period(
        body.yaw_gyradius_m, body.half_spacing_m, body.line_length_m, STANDARD_GRAVITY_M_S2
    )
    record = simulate_bifilar(
        body,
        effects=[*losses("yaw", "sway"), *instruments(0.05, 1e-3), *effects],
        seed=seed,
        yaw_rad=0.06,
        sway_m=0.04,
        stern_lever_m=3.0,
        duration_s=SWINGS * period,
        sample_rate_hz=20.0 / period,
    )
    return analyse_record(series_of(record, "stern_displacement"), modes=2)


def bifilar_campaign(generator: Generator) -> Campaign:
    """Four releases, yaw gyradius by the period: tape and lines off by what is stated."""
    hung = replace(
        HULL,
        half_spacing_m=HULL.half_spacing_m + TAPE_M * generator.standard_normal(),
        line_length_m=HULL.line_length_m + LINE_M * generator.standard_normal(),
    )
    runs = [bifilar_run(hung, **release(generator)) for _ in range(RUNS)]
    inputs = {
        "period_s": from_runs(runs).estimate,
        "half_spacing_m": Estimate.of(HULL.half_spacing_m, TAPE_M, "m"),
        "line_m": Estimate.of(HULL.line_length_m, LINE_M, "m"),
        "gravity_m_s2": G,
    }
    found = derived("k_yaw", yaw_gyradius, "m", **inputs)
    ideal = HULL.yaw_gyradius_m * math.sqrt(
        (TAPE_M / HULL.half_spacing_m) ** 2
        + (0.5 * LINE_M / HULL.line_length_m) ** 2
        + RELEASE**2 / RUNS
    )
    return Campaign(found, HULL.yaw_gyradius_m, ideal)


def pitch_campaign(generator: Generator) -> PendulumResult:
    """Return depth and pitch gyradius of the keelboat from three double pendulum records."""
    runs = []
    for _ in range(3):
        record = simulate_double_pendulum(
            HULL,
            effects=[*losses("surge", "pitch"), *instruments(0.002, 3e-4)],
            seed=int(generator.integers(2**31)),
            surge_m=0.06,
            pitch_rad=-0.02,
            duration_s=160.0,
            sample_rate_hz=20.0,
        )
        runs.append(analyse_record(series_of(record, "surge"), modes=2))
    slow, fast = (from_runs(runs, mode).estimate for mode in (0, 1))
    own = sway_period(HULL.line_length_m, STANDARD_GRAVITY_M_S2)
    return pitch_from_periods(slow, fast, Estimate.of(own, 1e-4 * own, "s"), G)


def swing_campaign(generator: Generator) -> Campaign:
    """Model's gyradius from the swing alone and with it: four releases and a lever each."""
    states: dict[str, Estimate] = {}
    bow = generator.uniform(-BOW, BOW)
    for key, model in (("tare", None), ("total", MODEL)):
        states[f"{key}_period_s"] = swing_period(model, generator)
        states[f"{key}_moment_kg_m"] = swing_moment(model, bow, generator)
    weighed = MODEL.mass_kg + SCALE_KG * generator.standard_normal()
    inputs = {**states, "model_mass_kg": Estimate.of(weighed, SCALE_KG, "kg"), "gravity_m_s2": G}
    found = derived("k_model", model_gyradius, "m", **inputs)
    known = {
        "period_s": RELEASE / math.sqrt(RUNS),
        "moment_kg_m": known_moment(),
        "mass_kg": SCALE_KG / MODEL.mass_kg,
        "m_s2": 0.0,
    }
    best = {
        name: Estimate.of(
            one.value,
            one.value * next(u for end, u in known.items() if name.endswith(end)),
            one.unit,
        )
        for name, one in inputs.items()
    }
    best |= {name: bowed(one) for name, one in best.items() if name.endswith("moment_kg_m")}
    ideal = derived("k_model", model_gyradius, "m", **best)
    true = math.sqrt(MODEL.inertia_kg_m2 / MODEL.mass_kg)
    return Campaign(found, true, ideal.uncertainty)


def swing_period(model: RigidPart | None, generator: Generator) -> Estimate:
    """Return the period of the swing over its releases, by the inclinometer that it carries."""
    runs = []
    for _ in range(RUNS):
        own = release(generator)
        record = simulate_swing(
            model=model,
            effects=[*losses("angle"), *instruments(2e-4, 5e-5), *own["effects"]],
            seed=own["seed"],
            sample_rate_hz=8.0,
        )
        runs.append(
            analyse_record(series_of(record, "inclinometer_angle"), lengthens=pendulum_lengthening)
        )
    return from_runs(runs).estimate


def tilt_relative() -> float:
    """Return the standard uncertainty of a slope over the tilts by the inclinometer's own bow."""
    x = TILTS_RAD / INCLINOMETER_RANGE_RAD
    slope = float(np.polyfit(x, 1.5 * math.sqrt(3.0) * x * (1.0 - x * x), 1)[0])
    return abs(2.0 * BOW * slope) / math.sqrt(3.0)


def bowed(moment: Estimate) -> Estimate:
    """Return a moment with the bow of the one inclinometer that reads all of them."""
    return moment.widened(moment.value * tilt_relative(), label="inclinometer")


def known_moment() -> float:
    """Return the relative standard uncertainty of a moment beside the inclinometer's bow."""
    x = np.tan(TILTS_RAD)
    reading = 2.0 * ZERO * INCLINOMETER_RANGE_RAD / math.sqrt(float(((x - x.mean()) ** 2).sum()))
    return math.hypot(LEVER_RELATIVE, reading)


def swing_moment(model: RigidPart | None, bow: float, generator: Generator) -> Estimate:
    """Return the first moment by weights at a lever that the tape does not quite know, F2.

    Parameters
    ----------
    bow
        Non-linearity of the inclinometer that happens to be there.
    """
    parts = [SWING_2021] + ([model] if model else [])
    hanging = sum(one.mass_kg * one.lever_m for one in parts)
    lever_m, weights_kg = 0.5, np.tan(TILTS_RAD) * hanging / 0.5

    def bent(bench: "PendulumBench") -> "PendulumBench":
        return bench.change_sensors(
            lambda one: replace(one, non_linearity=bow) if one.non_linearity else one
        )

    effects: list[Any] = [make_effect("sensor_noise", noise_rms=5e-5), bent]
    records = simulate_swing_static(
        weights_kg.tolist(),
        lever_m * (1.0 + LEVER_RELATIVE * generator.standard_normal()),
        model=model,
        effects=effects,
        seed=int(generator.integers(2**31)),
        sample_rate_hz=16.0,
    )
    tilts = [float(series_of(one, "inclinometer_angle").values.mean()) for one in records]
    own = fit_static([LeverSeries("C", lever_m, weights_kg, np.array(tilts))]).pooled.moment
    return bowed(own.widened(own.value * LEVER_RELATIVE))
