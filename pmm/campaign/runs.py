"""What a campaign says of its runs: set-points, records at rest, what each was recorded with."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.body import Body
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass, LoadStep
from hardware.description.lines import Line
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.model_uncertainty import ModelUncertainty
from sim.model.hull import HullCoefficients

_SET: Final = tuple(field.name for field in fields(SetPoint))


@dataclass(frozen=True)
class RecordedWith:
    """What a run was recorded with where it is not what the campaign's tables say of the others.

    Attributes
    ----------
    oscillator, model, model_uncertainty, hull, reference
        As in :class:`pmm.campaign.campaign.Campaign`; ``None`` where that is right for the run.
    """

    oscillator: Oscillator | None = None
    model: Body | None = None
    model_uncertainty: ModelUncertainty | None = None
    hull: HullCoefficients | None = None
    reference: ReferenceChoice | None = None


@dataclass(frozen=True)
class Asked:
    """What a run of the oscillator was told to do, and what it is called."""

    name: str
    frequency_hz: float
    eccentricity_m: float
    strut_phase_rad: float = 0.0
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    periods: int = 10
    drift_rad: float = 0.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0
    heel_rad: float = 0.0
    lines: tuple[Line, ...] = ()
    wave_frequency_hz: float = 0.0
    wave_amplitude_m: float = 0.0
    wave_heading_rad: float = math.pi
    steady_ahead: bool = False

    @property
    def set_point(self) -> SetPoint:
        """What the run was told to do."""
        return SetPoint(**_set_point_values(self))


@dataclass(frozen=True)
class Run(Asked):
    """One run: its set-point, how long it is, and where its recording lies.

    Attributes
    ----------
    name
        Unique within the campaign; its recording is called so.
    frequency_hz, eccentricity_m, strut_phase_rad, carriage_speed_m_s, medium, drift_rad
    rudder_angle_rad, revolutions_hz, heel_rad, lines, wave_frequency_hz, wave_amplitude_m
    wave_heading_rad, steady_ahead
        As in :class:`hardware.description.setpoint.SetPoint`.
    periods
        Whole periods wanted.
    file
        Recording of another system, beside the campaign file, or where run control has put its own;
        ``None`` for ``<name>.nc``.
    kind, motion, repeat, known_mass
        What the run was for; see :class:`pmm.plan.run_plan.RunPlan`.
    u_eccentricity_m, u_strut_phase_rad
        Standard uncertainties of how eccentricity and phase were set or read.
    zero_before, zero_after
        Names of the records at rest that tell the gauges' zero.
    number
        Place among all runs of the campaign, those at rest too, from 1.
    outcome
        ``"complete"``, ``"stopped"`` or ``"fault"``.
    differs
        What plan, rig, model and calibration said otherwise when it was recorded, in words.
    recorded_with
        Tables of the campaign that were others for it.
    """

    file: str | None = None
    kind: RunKind = RunKind.OSCILLATION
    motion: Motion | None = None
    repeat: int = 1
    u_eccentricity_m: float = 0.0
    u_strut_phase_rad: float = 0.0
    known_mass: KnownMass | None = None
    zero_before: str | None = None
    zero_after: str | None = None
    number: int | None = None
    outcome: str = "complete"
    differs: tuple[str, ...] = ()
    recorded_with: RecordedWith | None = None

    def recording_path(self, folder: Path) -> Path:
        """Return where the run's recording lies: ``<name>.nc`` if it is there, else ``file``."""
        return _recording_path(folder, self.name, self.file)


@dataclass(frozen=True)
class AtRest:
    """A record with the shaft at rest: a zero run, a load step, a push, a tow, a free decay.

    It carries no harmonics, so it stands beside the runs. Attributes are as in :class:`Run`; the
    file is beside the campaign file.

    Attributes
    ----------
    load
        Which gauge was loaded, and with what.
    """

    name: str
    kind: RunKind
    file: str
    duration_s: float
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    drift_rad: float = 0.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0
    heel_rad: float = 0.0
    turn_rate_rad_s: float = 0.0
    release_rad: float = 0.0
    repeat: int = 1
    load: LoadStep | None = None
    known_mass: KnownMass | None = None
    zero_before: str | None = None
    zero_after: str | None = None
    number: int | None = None
    outcome: str = "complete"
    differs: tuple[str, ...] = ()
    recorded_with: RecordedWith | None = None

    @property
    def set_point(self) -> SetPoint:
        """What the rig was told to do with its shaft at rest."""
        return SetPoint(**{"frequency_hz": 0.0, "eccentricity_m": 0.0, **_set_point_values(self)})

    def recording_path(self, folder: Path) -> Path:
        """Return where the recording lies, as for a run."""
        return _recording_path(folder, self.name, self.file)


def _set_point_values(run: "Asked | AtRest") -> dict[str, Any]:
    """Return what a run says of its set-point, by the keys that they have in common."""
    return {key: getattr(run, key) for key in _SET if hasattr(run, key)}


def _recording_path(folder: Path, name: str, file: str | None) -> Path:
    default_path = folder / f"{name}.nc"
    return default_path if file is None or default_path.exists() else folder / file


def nearest_run(name: str, names: Sequence[str]) -> str:
    """Return which run may be meant by a name that there is not, or which there are."""
    from difflib import get_close_matches

    near = get_close_matches(name, names, n=1, cutoff=0.4)
    return f"did you mean {near[0]!r}?" if near else f"runs: {', '.join(names)}"
