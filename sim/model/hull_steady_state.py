"""The periodic steady state of the model on its mounting: exact, the laws by harmonic balance."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.arrays import ComplexArray
from sim.model.forces import law_harmonics
from sim.model.law_point import Acting
from sim.model.model_march import periodic_laws
from sim.model.system import HullSystem
from sim.solve.period import Period, apply
from sim.solve.relaxation import relax

if TYPE_CHECKING:
    from sim.model.balance import LawBalance


@dataclass(frozen=True, eq=False)
class HullSteady:
    """A model over one period, at its mean speed.

    Harmonics of the struts have shape ``(orders + 1, 2)``, of forces ``(orders + 1, 3)``: aft, fore
    and along the model. ``laws`` are what :func:`sim.model.forces.law_forces` asks for.
    """

    acting: tuple[Acting, ...]
    system: HullSystem
    speed_m_s: float
    period: Period

    @cached_property
    def impedance(self) -> ComplexArray:
        """Force per displacement of the model, ``(orders + 1, 2, 2)``."""
        return self.system.impedance(self.period.s)[0]

    @cached_property
    def give(self) -> ComplexArray | None:
        """Deflection per rigid load, of the same shape; ``None`` for a rigid mounting."""
        return _mounting_gain(self.system, self.impedance, self.period)

    def force(self, y: ComplexArray, laws: ComplexArray) -> ComplexArray:
        """Return the forces where the laws ask for ``laws``."""
        h = self._model(y, laws)
        force = laws.copy()
        force[:, :2] += apply(self.impedance, h)
        return force

    def laws(self, y: ComplexArray, laws: ComplexArray) -> ComplexArray:
        """Return the laws' forces for the deflection that the forces ``laws`` cause."""
        if self._compiled is not None:
            return self._compiled.answer(y, laws)
        h = self._model(y, laws)
        column = self.period.s[:, np.newaxis]
        waves = np.hstack([h, h * column, h * column**2, apply(self.impedance, h)])
        return law_harmonics(self.acting, self.system, waves, self.period, self.speed_m_s)

    def balanced(self, y: ComplexArray) -> ComplexArray:
        """Return the forces, the laws in balance with the deflection that they cause."""
        laws = self.laws(y, np.zeros((len(y), 3), dtype=np.complex128))
        if self.give is None:
            return self.force(y, laws)
        found = None if self._compiled is None else self._compiled.settled(y, laws)
        if found is None:
            found = relax(lambda at: self.laws(y, at), laws, "hull", self.scale(y, laws))
        return self.force(y, found)

    def scale(self, y: ComplexArray, laws: ComplexArray) -> float:
        """Return what a change of the laws counts relative to: them, or the linear force.

        By the rounding of the linear force all of what is beyond it is off.
        """
        linear = apply(self.impedance, y)
        return float(max(np.abs(laws).max(), np.abs(linear).max()))

    def _model(self, y: ComplexArray, laws: ComplexArray) -> ComplexArray:
        """Return the motion of the model at the struts."""
        if self.give is None:
            return y
        return y + apply(self.give, apply(self.impedance, y) + laws[:, :2])

    @cached_property
    def _compiled(self) -> "LawBalance | None":
        table = periodic_laws(self.acting, self.system)
        if table is None:
            return None
        from sim.model.balance import LawBalance

        arguments = (table, self.system.parts, self.give, self.impedance)
        return LawBalance(*arguments, self.period, self.speed_m_s)


def _mounting_gain(
    system: HullSystem, impedance: ComplexArray, period: Period
) -> ComplexArray | None:
    """Return E p per rigid load, ``(orders + 1, 2, 2)``; ``None`` for a rigid mounting."""
    if not system.elastic_count:
        return None
    shape = system.elastic.shape
    total = shape.T @ impedance @ shape + system.mounting_impedance(period.s)
    pull = np.broadcast_to(shape.T.astype(complex), (period.s.size, *shape.T.shape))
    gain: ComplexArray = -shape @ np.linalg.solve(total, pull)
    return gain
