"""What the files of all swung and hung tests have in common."""

from dataclasses import dataclass, field

from hardware.description.oscillator import Plane
from pmm.configuration import STRICT_TABLE
from pmm.inertia.air import AirTable
from pmm.inertia.hanging import HangingTable
from pmm.inertia.outcome import TargetTable
from pmm.inertia.properties import ModelTable, PartTable


@dataclass(frozen=True, kw_only=True)
class JobTable:
    """The file of one test: its name, gravity and air, what was on it, and what is wanted of it.

    Attributes
    ----------
    hanging
        Plumb lines, which give the model's ``cg_x_m`` and ``cg_z_m``.
    take_off
        What moved too and is no part of the model.
    targets
        What the results are held against.
    photo
        Of the set-up: a JPEG or PNG file beside this one.
    plane
        Whose inertia ``--output`` writes, pitch or yaw; ``None`` for the one that was measured.
    """

    name: str
    gravity_m_s2: float | None = None
    u_gravity_m_s2: float = 0.0
    air_density_kg_m3: float = 0.0
    body_density_kg_m3: float | None = None
    entrained_air: AirTable | None = None
    hanging: HangingTable | None = None
    model: ModelTable = field(default_factory=ModelTable)
    take_off: tuple[PartTable, ...] = ()
    targets: tuple[TargetTable, ...] = ()
    photo: str | None = None
    plane: Plane | None = None
    monte_carlo_seed: int = 0

    __pydantic_config__ = STRICT_TABLE
