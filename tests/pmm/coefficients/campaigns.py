"""Campaign folders for the tests of this folder, simulated with a known truth."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from analysis.readers import from_dataset, write_recording
from analysis.recording import Recording
from hardware.description.setpoint import Medium, SetPoint
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate

HEAD = """name = "{name}"

[oscillator]
preset = "{plane}-1963"
"""
MODEL = """
[model]
mass_kg = {0.mass_kg}
inertia_kg_m2 = {0.inertia_kg_m2}
cg_x_m = {0.cg_x_m}
cg_z_m = {0.cg_z_m}

[model_uncertainty]
mass_kg = 0.02
inertia_kg_m2 = 0.05
"""
RUN = """
[[runs]]
name = "{name}"
frequency_hz = {point.frequency_hz}
eccentricity_m = {point.eccentricity_m}
strut_phase_rad = {point.strut_phase_rad}
carriage_speed_m_s = {point.carriage_speed_m_s}
medium = "{point.medium}"
"""


def head(rig: SimulatedRig, name: str = "trial", *, model: bool = True) -> str:
    plane = rig.oscillator.plane
    text = HEAD.format(name=name, plane=plane)
    rows = [list(row) for row in rig.water.restoring]
    text += f"\n[hull]\nrestoring = {rows}\n"
    return text + (MODEL.format(rig.body) if model else "")


def record(
    folder: Path, rig: SimulatedRig, name: str, point: SetPoint, *, seed: int = 1, periods: int = 6
) -> str:
    """Simulate a run into the folder and return its table."""
    found = simulate(rig, point, periods=periods, sample_rate_hz=100.0, seed=seed, name=name)
    write_recording(from_dataset(found), folder / f"{name}.nc")
    return RUN.format(name=name, point=point)


def pair(frequency_hz: float, speed_m_s: float = 1.2, eccentricity_m: float = 0.02):  # type: ignore[no-untyped-def]
    """Both motions: strut phases 0 and pi."""
    return [
        (f"{kind}-{frequency_hz}-{1e3 * eccentricity_m:g}",
         SetPoint(frequency_hz, eccentricity_m, phase, speed_m_s))
        for kind, phase in (("one", 0.0), ("two", math.pi))
    ]  # fmt: skip


def vertical_campaign(
    folder: Path,
    frequencies_hz: Sequence[float] = (0.6, 0.9),
    *,
    model: bool = True,
    dry: bool = False,
    only: int = 2,
    name: str = "trial",
) -> SimulatedRig:
    """Write a campaign of heave and pitch with speed; return the rig that made it."""
    rig = vertical_rig()
    folder.mkdir(parents=True, exist_ok=True)
    text = head(rig, name, model=model)
    for k, frequency in enumerate(frequencies_hz):
        for own, point in pair(frequency)[:only]:
            text += record(folder, rig, own, point, seed=k)
            if dry:
                air = SetPoint(frequency, 0.02, point.strut_phase_rad, 0.0, Medium.AIR)
                text += record(folder, rig, f"dry-{own}", air, seed=50 + k)
    (folder / "campaign.toml").write_text(text)
    return rig


def at_rest(name: str, mean: tuple[float, float], *, started: str | None = None) -> Recording:
    """A record of the gauges at rest, 10 s."""
    from hardware.description.channels import FORCE_AFT, FORCE_FORE

    generator = np.random.default_rng(len(name))
    samples = np.array(mean)[:, None] + 0.01 * generator.standard_normal((2, 1000))
    about = {} if started is None else {"started_utc": started}
    return Recording(name, (FORCE_AFT, FORCE_FORE), samples, 100.0, provenance=about)


__all__ = ["at_rest", "head", "horizontal_rig", "pair", "record", "vertical_campaign"]
