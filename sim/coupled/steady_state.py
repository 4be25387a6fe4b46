"""The periodic steady state of a drive that feels its load, with the load it feels."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from hardware.description.arrays import ComplexArray
from sim import signals
from sim.drive.loaded_drive import LoadedDrive
from sim.model.hull import Hull
from sim.model.hull_steady_state import HullSteady
from sim.periodic import steady_of
from sim.solve.period import Period, Spectra
from sim.solve.relaxation import relax
from sim.stage import Stage

_STRUTS = ("force_aft", "force_fore")
_LOADING = ("shaft_angle", "shaft_speed", "lever_aft", "lever_fore", *_STRUTS)


@dataclass
class CoupledSteady:
    """Sweeps of torque, motion and force over a period, until they fit each other.

    What is swept is one array, a column each: the torque less the reflected inertia's, and with
    a mounting that gives way, what the laws ask for at both struts and along the model. So the
    laws come to terms with mounting and drive at once.
    """

    drive: LoadedDrive
    mechanism: Stage[Any]
    hull: Stage[Any]
    period: Period
    inputs: Spectra

    def __post_init__(self) -> None:
        self._real = self.period
        self._found: dict[str, ComplexArray] = {}
        self._model: HullSteady | None = None
        self._swept = _with_swept_laws(self.hull)

    def solve(self) -> tuple[Period, Spectra]:
        """Return the period that the shaft has under its load, and the harmonics of all parts."""
        columns = 1 if self._swept is None else 4
        nothing = np.zeros((self.period.orders + 1, columns), dtype=np.complex128)
        start = self._respond(nothing)
        size = np.full(columns, np.abs(start[:, 0]).max())
        if self._model is not None:
            size[1:] = self._model.scale(_struts(self._found), start[:, 1:])
        relax(self._respond, start, self.drive.name, size)
        return self._real, self._found

    def _respond(self, at: ComplexArray) -> ComplexArray:
        inputs = self.inputs
        torque = {signals.LOAD_TORQUE.name: at[:, 0]}
        self._real, shaft = self.drive.steady(self.period, torque)
        spectra: dict[str, ComplexArray] = {**inputs, **shaft}
        motion = steady_of(self.mechanism, self._real, {**spectra, **inputs})[1]
        spectra = {**spectra, **motion, **inputs}
        laws = at[:, 1:]
        if self._swept is None:
            forces = steady_of(self.hull, self._real, spectra)[1]
        else:
            forces, laws = self._forces(self._swept, spectra, laws)
        spectra = {**spectra, **forces, **inputs}
        names = list(_LOADING)
        values = self._real.values(np.stack([spectra[name] for name in names], axis=1)).T
        load = self.drive.load(
            dict(zip(names, values, strict=True)), self._real.omega_rad_s * self._real.time_s
        )
        torque_now = self._real.harmonics(load)
        self._found = {**spectra, signals.LOAD_TORQUE.name: torque_now}
        inertia = self.drive.reflected_inertia_kg_m2
        rest = torque_now - inertia * spectra[signals.SHAFT_ACCELERATION.name]
        return np.column_stack([rest, laws])

    def _forces(
        self, hull: Hull, spectra: Spectra, laws: ComplexArray
    ) -> tuple[Spectra, ComplexArray]:
        """Return the struts' forces and what the laws ask for, after one sweep."""
        model = self._model
        if model is None or model.period != self._real:
            at = hull.at_speed(spectra)
            steady = HullSteady(at.laws, at.system, at.carriage_speed_m_s, self._real)
            model = self._model = steady
        y = _struts(spectra)
        laws = model.laws(y, laws)
        names = (signal.name for signal in hull.writes)
        return dict(zip(names, model.force(y, laws).T, strict=True)), laws


def _struts(spectra: Spectra) -> ComplexArray:
    return np.stack([spectra["displacement_aft"], spectra["displacement_fore"]], axis=1)


def _with_swept_laws(hull: Stage[Any]) -> Hull | None:
    """Return the model if the balance of its laws and mounting can be part of the sweeps."""
    if type(hull) is not Hull or hull.mounting.joint is not None or not hull.system.elastic_count:
        return None
    return hull
