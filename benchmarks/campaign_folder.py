"""A campaign of recordings made by closed form: as many runs as are wanted, in no time."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from analysis.readers import write_recording
from analysis.recording import Recording
from hardware.description.channels import CARRIAGE_SPEED, STANDARD, Channel
from hardware.description.setpoint import SetPoint
from sim.rig import vertical_rig
from tests.analysis.ideal_run import IdealRun, LinearHull, ideal_run

RATE_HZ, SECONDS, SPEED = 200.0, 60.0, 1.2
CHANNELS = (
    *STANDARD[: STANDARD.index(CARRIAGE_SPEED) + 1],
    Channel("wave", "m"),
)
_NOISE = (1e-5, 5e-6, 5e-6, 0.05, 0.05, 0.05, 1e-3, 1e-3)
_REPEATS, _AMPLITUDES = 5, (0.01, 0.015, 0.02, 0.025, 0.03)
_HEAD = """name = "benchmark"

[oscillator]
preset = "vertical-1963"

[model]
mass_kg = {body.mass_kg}
inertia_kg_m2 = {body.inertia_kg_m2}
cg_x_m = {body.cg_x_m}
cg_z_m = {body.cg_z_m}

[model_uncertainty]
mass_kg = 0.02
inertia_kg_m2 = 0.05

[hull]
restoring = {restoring}
"""
_RUN = """
[[runs]]
name = "{name}"
frequency_hz = {point.frequency_hz}
eccentricity_m = {point.eccentricity_m}
strut_phase_rad = {point.strut_phase_rad}
carriage_speed_m_s = {point.carriage_speed_m_s}
"""


def make_campaign(folder: Path, runs: int, seconds: float = SECONDS) -> Path:
    """Write a campaign of heave and pitch: 10 runs a set-point, then the next frequency."""
    rig = vertical_rig()
    water = rig.water
    hull = LinearHull(
        added_mass=np.array(water.added_mass),
        damping=np.array(water.damping),
        restoring=np.array(water.restoring),
    )
    restoring = [list(row) for row in water.restoring]
    text = _HEAD.format(body=rig.body, restoring=restoring)
    for k, point in enumerate(set_points(runs)):
        name = f"run-{k:04d}"
        own = ideal_run(rig.oscillator, point, rig.body, hull)
        write_recording(recording(name, point, own, seconds, k), folder / f"{name}.nc")
        text += _RUN.format(name=name, point=point)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


def set_points(runs: int) -> list[SetPoint]:
    """Return heave and pitch in turn, five repeats of five amplitudes at each frequency."""
    each = 2 * _REPEATS * len(_AMPLITUDES)
    found = []
    for k in range(runs):
        frequency, place = divmod(k, each)
        amplitude = _AMPLITUDES[place // (2 * _REPEATS)]
        phase = (0.0, math.pi)[place % 2]
        found.append(SetPoint(round(0.3 + 0.05 * frequency, 2), amplitude, phase, SPEED))
    return found


def recording(name: str, point: SetPoint, ideal: IdealRun, seconds: float, seed: int) -> Recording:
    """Return all channels of an ideal run with white noise."""
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    angle = 2.0 * math.pi * point.frequency_hz * time
    turn = np.exp(1j * angle)
    phasors = np.concatenate((ideal.displacements[1], ideal.forces[1]))
    waves = (phasors[:, None] * turn).imag
    steady = np.array([[-8.0], [SPEED], [0.0]]) * np.ones_like(time)
    samples = np.concatenate((angle[None], waves, steady))
    noise = np.random.default_rng(seed).standard_normal(samples.shape)
    samples += noise * np.array(_NOISE)[:, None]
    return Recording(name, CHANNELS, samples, RATE_HZ, set_point=replace(point))
