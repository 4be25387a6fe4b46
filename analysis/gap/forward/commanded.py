"""What recorded commands tell of the settings: where each is, and how well that is known.

A strut that follows its command with gain g and lag tau has an eccentricity of ``g e`` and a crank
that is behind by ``w tau``. A phase reference that is the command itself comes early by the lag. A
lag that grows is a shaft that turns slower than it was told. What a comparison cannot see adds to
its uncertainty: the displacement sensor's gain, the drive's clock.
"""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun
from analysis.uncertainty.estimate import Estimate, difference, joint
from analysis.uncertainty.redundancy import best_fit
from hardware.description.channels import COMMANDS, DISPLACEMENTS
from sim.acquisition.photocell import PhotocellStage
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig

_STRUTS: Final = ("aft", "fore")
_ECCENTRICITIES: Final = tuple(f"eccentricity {strut}" for strut in _STRUTS)
_PHASE, _FREQUENCY, _REFERENCE = "strut phase", "frequency", "phase reference"
_TOLERANCES: Final = {
    **dict.fromkeys(_ECCENTRICITIES, "eccentricity_m"),
    _PHASE: "strut_phase_rad",
    _FREQUENCY: "frequency_relative",
    _REFERENCE: "photocell_angle_rad",
}

_UNLIKE: Final = 0.1  # relative: eccentricities by which a factor is told from what is added


class _Deviation(NamedTuple):
    """By how much a setting of one run is off; an eccentricity relative to the one that was set."""

    name: str
    deviation: Estimate
    eccentricity_m: float


@dataclass(frozen=True, eq=False)
class KnownSetting:
    """One setting as the commands tell it.

    Attributes
    ----------
    deviation
        By how much it is off from what the simulation states, the mean of the runs: eccentricities
        relative to what was set.
    added_m
        What an eccentricity is off besides, whatever was set; ``None`` where all runs have one
        eccentricity.
    tolerance
        How well it is known, of what the comparison cannot see too, in the tolerance's unit.
    runs
        How many tell it.
    """

    name: str
    deviation: Estimate
    added_m: Estimate | None
    tolerance: float
    runs: int

    @property
    def key(self) -> str:
        """The tolerance that it belongs to."""
        return _TOLERANCES[self.name]


@dataclass(frozen=True, eq=False)
class Commanded:
    """The rig as its commands tell it, and the tolerances that are left about that."""

    rig: SimulatedRig
    tolerances: Tolerances
    known_settings: tuple[KnownSetting, ...]


def commanded(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    tolerances: Tolerances,
    on: Sequence[Effect] = (),
    reference: str | None = None,
    stated: Collection[str] = (),
) -> Commanded:
    """Return the settings that recorded commands tell; without any, what is given.

    Parameters
    ----------
    on
        Effects that are known already: what they put off is not told twice.
    reference
        The channel that tells the phase, if one does.
    stated
        Keys of tolerances that the user states: what these are of stays as it is stated.
    """
    offs_by_name: dict[str, list[_Deviation]] = {}
    for run in runs:
        for off in _of_run(rig, run, on, reference) if run.following else ():
            if _TOLERANCES[off.name] not in stated:
                offs_by_name.setdefault(off.name, []).append(off)
    settings = tuple(_known_setting(offs, tolerances) for offs in offs_by_name.values())
    wide: dict[str, float] = {}
    for setting in settings:
        rig = _MOVED[setting.name](rig, setting)
        wide[setting.key] = max(wide.get(setting.key, 0.0), setting.tolerance)
    return Commanded(rig, replace(tolerances, **wide), settings)


def _of_run(
    rig: SimulatedRig, run: GapRun, on: Sequence[Effect], reference: str | None
) -> Iterator[_Deviation]:
    acting, set_point = switch_on(on, rig, run.set_point, run.place)
    omega, set_m = 2.0 * math.pi * set_point.frequency_hz, set_point.eccentricity_m
    linkages = (acting.linkage_aft, acting.linkage_fore)
    pairs = [run.following.get(channel) for channel in DISPLACEMENTS]
    for name, linkage, pair in zip(_ECCENTRICITIES, linkages, pairs, strict=True):
        if pair is not None:
            off = pair.gain.value - linkage.eccentricity_m(set_m) / set_m
            yield _Deviation(name, pair.gain.following(off, 1.0), set_m)
    rate = min(
        (pair.clock_rate for pair in pairs if pair), key=lambda estimate: estimate.uncertainty
    )
    slower = rate.following(-rate.value - acting.drive.speed_error, -1.0)
    yield _Deviation(_FREQUENCY, replace(slower, unit="1"), set_m)
    aft, fore = (None if pair is None else _lead_angle(pair.lag_s, omega) for pair in pairs)
    if aft is not None and fore is not None:
        set_rad = linkages[1].phase_error_rad - linkages[0].phase_error_rad
        yield _Deviation(_PHASE, _angle_difference(difference(fore, aft), set_rad), set_m)
    if aft is not None and reference == COMMANDS[0]:
        cell = acting.photocell or PhotocellStage()
        mark_rad = cell.mark_angle_rad + omega * cell.latency_s
        yield _Deviation(_REFERENCE, _angle_difference(aft, mark_rad), set_m)


def _lead_angle(lag_s: Estimate, omega: float) -> Estimate:
    """Return the angle that a strut is ahead of its command."""
    return replace(lag_s.following(-omega * lag_s.value, -omega), unit="rad")


def _angle_difference(angle: Estimate, stated_rad: float) -> Estimate:
    """Return an angle less what is stated of it, within half a turn of nothing."""
    return angle.following(math.remainder(angle.value - stated_rad, 2.0 * math.pi), 1.0)


def _known_setting(offs: Sequence[_Deviation], tolerances: Tolerances) -> KnownSetting:
    """Return what the runs have in common; where they do not agree, Birge's ratio widens it."""
    name, unit = offs[0].name, offs[0].deviation.unit
    set_m = np.array([off.eccentricity_m for off in offs])
    struts = name in _ECCENTRICITIES
    has_added = struts and float(np.ptp(set_m)) > _UNLIKE * float(set_m.max())
    matrix = np.column_stack(
        [np.ones(len(offs)), 1.0 / set_m] if has_added else [np.ones(len(offs))]
    )
    fitted, _ = best_fit(
        matrix,
        joint([off.deviation for off in offs]),
        subject=name,
        results=(name, "added")[: matrix.shape[1]],
        data=[f"run {number + 1}" for number in range(len(offs))],
    )
    off = Estimate(fitted.select([0]), unit)
    added_m = Estimate(fitted.select([1]), "m") if has_added else None
    uncertainty, unseen = (
        off.uncertainty,
        tolerances.frequency_relative if name == _FREQUENCY else 0.0,
    )
    if struts:
        in_metres = fitted.mapped(set_m[:, None] * matrix)
        uncertainty = float(in_metres.standard_uncertainty.max())
        unseen = tolerances.displacement_gain_relative * float(set_m.max())
    return KnownSetting(name, off, added_m, math.hypot(uncertainty, unseen), len(offs))


def _eccentricity(strut: str) -> Callable[[SimulatedRig, KnownSetting], SimulatedRig]:
    def moved(rig: SimulatedRig, setting: KnownSetting) -> SimulatedRig:
        linkage = rig.linkage_aft if strut == "aft" else rig.linkage_fore
        added_m = 0.0 if setting.added_m is None else setting.added_m.value
        off = replace(
            linkage,
            gain=linkage.gain + setting.deviation.value,
            eccentricity_error_m=linkage.eccentricity_error_m + added_m,
        )
        return replace(rig, linkage_aft=off) if strut == "aft" else replace(rig, linkage_fore=off)

    return moved


def _strut_phase(rig: SimulatedRig, setting: KnownSetting) -> SimulatedRig:
    fore = rig.linkage_fore
    turned = replace(fore, phase_error_rad=fore.phase_error_rad + setting.deviation.value)
    return replace(rig, linkage_fore=turned)


def _frequency(rig: SimulatedRig, setting: KnownSetting) -> SimulatedRig:
    speed_error = rig.drive.speed_error + setting.deviation.value
    return replace(rig, drive=replace(rig.drive, speed_error=speed_error))


def _reference(rig: SimulatedRig, setting: KnownSetting) -> SimulatedRig:
    cell = rig.photocell or PhotocellStage()
    marked = replace(cell, mark_angle_rad=cell.mark_angle_rad + setting.deviation.value)
    return replace(rig, photocell=marked)


_MOVED: Final[Mapping[str, Callable[[SimulatedRig, KnownSetting], SimulatedRig]]] = {
    **{name: _eccentricity(strut) for name, strut in zip(_ECCENTRICITIES, _STRUTS, strict=True)},
    _PHASE: _strut_phase,
    _FREQUENCY: _frequency,
    _REFERENCE: _reference,
}
