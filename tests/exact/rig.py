"""What an exact rig is told, and where its points are."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrangement import Arrangement, DriftBy, Joint, Pivot
from hardware.description.oscillator import Plane
from tests.exact.hull import Hull, polynomial
from tests.exact.jet import Jet, Values, jet, turned, wave

GRAVITY_M_S2 = 9.80665


@dataclass(frozen=True)
class ExactBody:
    """The model; points from its reference point, ahead and to the positive side.

    ``inertia_kg_m2`` is about the reference point. The displaced mass buoys the vertical plane's
    model at its centre, always.
    """

    mass_kg: float = 0.0
    inertia_kg_m2: float = 0.0
    cg_x_m: float = 0.0
    cg_across_m: float = 0.0
    displaced_kg: float = 0.0
    buoyancy_x_m: float = 0.0
    buoyancy_across_m: float = 0.0

    def afloat(self) -> "ExactBody":
        """Return a body that the water bears: of weight and buoyancy ``m g z_G`` is left."""
        below = self.cg_across_m if self.displaced_kg else 0.0  # nothing to the side, z_G below
        return replace(
            self,
            cg_across_m=below,
            displaced_kg=self.mass_kg,
            buoyancy_x_m=self.cg_x_m,
            buoyancy_across_m=0.0,
        )


@dataclass(frozen=True, eq=False)
class ExactRig:
    """A run of an exact rig.

    Attributes
    ----------
    coordinates
        Phasors of what is driven, shape ``(orders + 1, 2)``, ``Im(H[n] exp(i n theta))`` and the
        real mean H[0]: the displacements of the aft and fore strut about the positions that the
        drift sets, m; or sway (heave), m, and the turntable's angle, rad.
    drift_rad
        Mean heading of the model, bow to starboard (bow up).
    hull
        Of the water, about the reference point.
    restoring
        Hydrostatic, against force and moment of the hull, per displacement of the reference point
        across the tank and per angle of the model in it; there at rest, too.
    """

    coordinates: Values
    frequency_hz: float
    speed_m_s: float = 0.0
    drift_rad: float = 0.0
    plane: Plane = Plane.HORIZONTAL
    half_spacing_m: float = 0.5
    arrangement: Arrangement = field(default_factory=Arrangement)
    body: ExactBody = ExactBody()
    hull: Hull = field(default_factory=lambda: polynomial({}))
    restoring: NDArray[np.float64] = field(default_factory=lambda: np.zeros((2, 2)))

    @property
    def omega(self) -> float:
        """Angular frequency, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def side(self) -> float:
        """+1 where the rotation turns ahead into across; pitch, bow up, turns ahead off down."""
        return -1.0 if self.plane is Plane.VERTICAL else 1.0


@dataclass(frozen=True, eq=False)
class Points:
    """Points and unit vectors in the tank's frame.

    Attributes
    ----------
    pivot, slide
        Where the struts hold the model; the turntable holds it at one point.
    reference
        The model's own, half the spacing off the pivot.
    along
        Unit vector along the line of the struts (the turntable), ahead.
    ahead
        Of the model.
    rail
        Of the rig.
    centre, buoyancy
        Centres of gravity and of buoyancy.
    """

    pivot: Jet
    slide: Jet
    reference: Jet
    along: Jet
    ahead: Jet
    rail: complex
    centre: Jet
    buoyancy: Jet


def points(rig: ExactRig, theta: NDArray[np.float64]) -> Points:
    """Return where everything is at some shaft angles."""
    by, half, body = rig.arrangement.drift_by, rig.half_spacing_m, rig.body
    angle = rig.side * rig.drift_rad
    rail = complex(np.exp(1j * angle)) if by is DriftBy.RIG_TURNED else 1.0 + 0j
    setting = angle if by is DriftBy.STRUTS_OFFSET else 0.0
    time = theta / rig.omega
    speed = np.full(theta.shape, rig.speed_m_s, dtype=np.complex128)
    carriage = Jet(speed * time, speed, np.zeros_like(speed))
    pivot, slide, along = _held(rig, setting, theta)
    ends = [carriage + rail * one for one in (pivot, slide)]
    along = rail * along
    ahead_of_pivot = half if rig.arrangement.pivot is Pivot.AFT else -half
    if rig.arrangement.joint is Joint.YAW_TABLE:
        ahead_of_pivot = 0.0
    reference = ends[0] + along * ahead_of_pivot
    ahead = along * (np.exp(1j * angle) if by is DriftBy.MODEL_TURNED else 1.0)
    centre = reference + ahead * (body.cg_x_m + 1j * body.cg_across_m)
    buoyancy = reference + ahead * (body.buoyancy_x_m + 1j * body.buoyancy_across_m)
    return Points(ends[0], ends[1], reference, along, ahead, rail, centre, buoyancy)


def _held(rig: ExactRig, setting: float, theta: NDArray[np.float64]) -> tuple[Jet, Jet, Jet]:
    """Pivot, slide and direction of the line of the struts, in the rig's frame."""
    first, second = (wave(column, rig.omega, theta) for column in rig.coordinates.T)
    half, joint = rig.half_spacing_m, rig.arrangement.joint
    if joint is Joint.YAW_TABLE:
        place = first * 1j
        return place, place, turned(second * rig.side + setting)
    lever = np.tan(setting) if joint is Joint.SLIDES_ON_MODEL else np.sin(setting)
    aft, fore = first - half * lever, second + half * lever
    spread = fore - aft
    reach = jet(2.0 * half)
    if joint is Joint.SLIDES_ON_RIG:
        reach = (4.0 * half**2 - spread * spread).power(0.5)
    line = reach + spread * 1j
    along = line * line.length().power(-1.0)
    if rig.arrangement.pivot is Pivot.AFT:
        return aft * 1j - half, aft * 1j - half + line, along
    return fore * 1j + half, fore * 1j + half - line, along
