"""Zeros, pluck tests and known masses: what they say of the rig, from a campaign's folder."""

import cmath
import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from analysis.inertia.damped_fit import fit_damped
from analysis.inertia.spectrum import spectrum
from analysis.resolver.harmonics import Harmonics
from analysis.uncertainty.freedom import effective_freedom, student_factor
from hardware.description.arrays import FloatArray
from hardware.description.channels import CARRIAGE_SPEED
from hardware.description.errors import DataError
from hardware.description.setpoint import ANGLE_KEYS
from pmm.document.notation import degrees
from pmm.evaluation.run_results import RunResult

_LOWEST_CYCLES: Final = 5.0  # of a mode in the record: below, it is drift
_RING_TIMES: Final = 10.0  # over the median of the spectrum: what stands out so far rings


@dataclass(frozen=True)
class GaugeZeros:
    """A gauge's zero over the campaign in one state, and its largest change from one to the next.

    Attributes
    ----------
    state
        Medium, drift (or trim), heel and known mass, in words: each of them moves the zero itself.
    largest_change_n
        NaN of one zero run alone.
    """

    channel: str
    state: str
    first_n: float
    last_n: float
    largest_change_n: float


@dataclass(frozen=True)
class RungMode:
    """A natural frequency found by a pluck test."""

    name: str
    frequency_hz: float
    standard_uncertainty_hz: float
    damping_ratio: float
    channel: str

    def as_table(self) -> dict[str, Any]:
        """Return it with the keys of a rig's ``[[modes]]``."""
        return {
            "name": self.name,
            "frequency_hz": self.frequency_hz,
            "damping_ratio": self.damping_ratio,
        }


@dataclass(frozen=True)
class GaugeResponse:
    """What a gauge makes of a known inertia force.

    Attributes
    ----------
    gain
        Reading over force; its sign is that of the gauge.
    lag_s
        By which the reading is late.
    gain_half_width, lag_half_width_s
        Of 95 % intervals, from the scatter of both runs' readings.
    """

    run: str
    channel: str
    frequency_hz: float
    gain: float
    gain_half_width: float
    lag_s: float
    lag_half_width_s: float


@dataclass(frozen=True)
class TowedSpeed:
    """How the carriage ran while a run was measured, by its own measurement.

    Attributes
    ----------
    speed_m_s, mean_m_s, deviation_m_s
        Speed asked for, its mean over the gate, and its standard deviation about that.
    """

    run: str
    speed_m_s: float
    mean_m_s: float
    deviation_m_s: float

    @property
    def off_percent(self) -> float:
        """The mean's difference from what was asked, in percent of that."""
        return 100.0 * (self.mean_m_s / self.speed_m_s - 1.0)


def towed_speeds(runs: Sequence[RunResult]) -> tuple[TowedSpeed, ...]:
    """Return how the carriage ran, of each tow at one speed that measured it."""
    speeds = []
    for run in runs:
        point = run.plan["set_point"]
        speed_m_s = float(point.get("carriage_speed_m_s", 0.0))
        if (
            not speed_m_s
            or point.get("steady_ahead")
            or CARRIAGE_SPEED.name not in (channel.name for channel in run.header.channels)
        ):
            continue
        recording, gate = run.gate_samples()
        speed = recording.values(CARRIAGE_SPEED.name)[gate]
        speeds.append(
            TowedSpeed(run.name, speed_m_s, float(np.nanmean(speed)), float(np.nanstd(speed)))
        )
    return tuple(speeds)


def zero_drifts(runs: Sequence[RunResult]) -> tuple[GaugeZeros, ...]:
    """Return how the zero of each gauge moved over the zero runs of each state."""
    means: dict[str, list[dict[str, float]]] = defaultdict(list)
    for run in runs:
        means[_state(run)].append(run.means())
    drifts = []
    for name in runs[0].forces if runs else ():
        for state, of_state in means.items():
            values = np.array([mean[name] for mean in of_state])
            largest = float(np.abs(np.diff(values)).max()) if values.size > 1 else math.nan
            drifts.append(GaugeZeros(name, state, float(values[0]), float(values[-1]), largest))
    return tuple(drifts)


def _state(run: RunResult) -> str:
    point, mass = run.plan["set_point"], run.plan.get("known_mass")
    words = [str(point["medium"])]
    words += [
        f"{axis} {degrees(point[key])} deg" for axis, key in ANGLE_KEYS.items() if point.get(key)
    ]
    if mass:
        words.append(f"{mass['mass_kg']:g} kg at {mass.get('x_m', 0.0):g} m")
    return ", ".join(words)


def rung_modes(runs: Sequence[RunResult]) -> tuple[RungMode, ...]:
    """Return the mode that each pluck test shows best.

    Raises
    ------
    DataError
        If a record holds no ring-down.
    """
    return tuple(_mode(run) for run in runs)


def known_mass_responses(
    mass_runs: Sequence[RunResult], dry_runs: Sequence[RunResult], half_spacing_m: float
) -> tuple[GaugeResponse, ...]:
    """Return each gauge's gain and lag from what a known mass adds to a dry run.

    The difference of two runs in air at one set-point is the inertia force of the mass alone, so
    that nothing has to be known of the model. A gauge whose part of that force is within the
    uncertainty of its readings tells nothing and has no response.

    Raises
    ------
    DataError
        If a recording is damaged or tells no harmonics.
    """
    responses: list[GaugeResponse] = []
    for run in mass_runs:
        base = next((dry_run for dry_run in dry_runs if _same_condition(run, dry_run)), None)
        if base is not None:
            responses += _responses(run, base, half_spacing_m)
    return tuple(responses)


def _same_condition(run: RunResult, dry_run: RunResult) -> bool:
    point, dry_point = run.plan["set_point"], dry_run.plan["set_point"]
    keys = ("frequency_hz", "eccentricity_m", "strut_phase_rad", "medium")
    return all(point[key] == dry_point[key] for key in keys)


def _responses(run: RunResult, base: RunResult, half_m: float) -> list[GaugeResponse]:
    point, mass = run.plan["set_point"], run.plan["known_mass"]
    frequency_hz = float(point["frequency_hz"])
    omega = 2.0 * math.pi * frequency_hz
    # Displacements as phasors of e sin(theta): in phase is real.
    aft = complex(point["eccentricity_m"])
    fore = aft * cmath.exp(1j * point["strut_phase_rad"])
    slope = (fore - aft) / (2.0 * half_m)
    place = (aft + fore) / 2.0 + slope * mass["x_m"]
    force = -(omega**2) * mass["mass_kg"] * place
    moment = -(omega**2) * float(_own_inertia(mass)) * slope + force * mass["x_m"]
    forces = {
        "force_aft": force / 2.0 - moment / (2.0 * half_m),
        "force_fore": force / 2.0 + moment / (2.0 * half_m),
    }
    readings = (run.resolved(), base.resolved())
    responses = []
    for channel, value in forces.items():
        if any(channel not in reading.channel_names for reading in readings):
            continue
        added, uncertainty = _added(*readings, channel)
        phase = cmath.phase(added)
        along = float(np.linalg.norm([math.cos(phase), math.sin(phase)] @ uncertainty))
        across = float(np.linalg.norm([-math.sin(phase), math.cos(phase)] @ uncertainty))
        if not abs(value) > along:  # nor where no interval is known
            continue
        ratio = added / value
        sign = -1.0 if ratio.real < 0.0 else 1.0
        responses.append(
            GaugeResponse(
                run.name,
                channel,
                frequency_hz,
                sign * abs(ratio),
                along / abs(value),
                -cmath.phase(sign * ratio) / omega,
                across / abs(added) / omega,
            )
        )
    return responses


def _added(run: Harmonics, base: Harmonics, channel: str) -> tuple[complex, FloatArray]:
    """Return what a run's first harmonic has more than another's, and its uncertainty.

    The latter is ``H``, shape ``(2, deviates)``: ``|n H|`` is the half-width of the 95 % interval
    in the direction ``n`` of (in phase, quadrature); NaN where a run has too few periods.
    """
    values, deviations, freedoms = [], [], []
    for reading in (run, base):
        row = reading.channel_names.index(channel)
        values.append(complex(reading.in_phase[row, 0], reading.quadrature[row, 0]))
        deviations.append(reading.deviations[row, 1:3])
        freedoms.append(float(reading.degrees_of_freedom[1]))
    variances = np.array([[np.sum(deviation**2)] for deviation in deviations])
    factor = student_factor(effective_freedom(variances, np.array(freedoms)))[0]
    return values[0] - values[1], factor * np.hstack(deviations)


def _own_inertia(mass: dict[str, Any]) -> float:
    return float(mass.get("own_inertia_kg_m2") or mass.get("inertia_kg_m2") or 0.0)


def _mode(run: RunResult) -> RungMode:
    """Fit the ring-down of the channel that rings loudest, from its largest swing on."""
    recording, gate = run.gate_samples()
    rate = recording.sample_rate_hz
    best: tuple[float, float, str] = (0.0, 0.0, "")
    for name in run.forces:
        values = recording.values(name)[gate]
        force_spectrum = spectrum(values - np.nanmean(values), rate)
        usable = force_spectrum.frequency_hz > _LOWEST_CYCLES * rate / values.size
        level = force_spectrum.amplitude[usable]
        peak = int(np.argmax(level))
        times = float(level[peak] / np.median(level))
        best = max(best, (times, float(force_spectrum.frequency_hz[usable][peak]), name))
    times, frequency_hz, channel = best
    if times < _RING_TIMES:
        raise DataError(
            f"{run.name}: the loudest line is {times:.1f} times the noise (limit {_RING_TIMES:g}); "
            "pluck harder, within the first third of the record"
        )
    values = recording.values(channel)[gate]
    start = int(np.nanargmax(np.abs(values - np.nanmedian(values)))) + 1
    ringing = values[start:]
    time_s = np.arange(ringing.size) / rate
    fit = fit_damped(time_s, ringing, start_periods_s=(1.0 / frequency_hz,), where=run.name)
    mode = fit.modes[0]
    frequency_hz = 1.0 / mode.period_s
    spread_hz = fit.period_uncertainty_s() * frequency_hz**2
    name = run.plan.get("entry") or run.name
    return RungMode(name, frequency_hz, spread_hz, mode.damping_ratio, channel)
