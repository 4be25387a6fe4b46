"""How struts, gauges and a drift angle are arranged: what decides the rig's exact geometry.

The words are explained, with a drawing, in ``docs/conventions.md``.
"""

from dataclasses import dataclass
from enum import StrEnum


class Joint(StrEnum):
    """What gives as the distance between the attachments changes.

    ``slides_on_model``: the struts keep their spacing on the rig and one attachment slides along
    the model. ``slides_on_rig``: the attachments keep it on the model and one strut slides along
    the rig. ``yaw_table``: one strut and a turntable, whose angle is the rotation itself and whose
    dynamometer reads force and moment.
    """

    SLIDES_ON_MODEL = "slides_on_model"
    SLIDES_ON_RIG = "slides_on_rig"
    YAW_TABLE = "yaw_table"


class Pivot(StrEnum):
    """The strut that does not slide: it alone carries the force along the line of the struts."""

    AFT = "aft"
    FORE = "fore"


class Gauges(StrEnum):
    """What the dynamometers, ``force_x`` among them, turn with: the model or the rig (not)."""

    MODEL = "model"
    RIG = "rig"


class DriftBy(StrEnum):
    """How a drift (trim) angle is set.

    ``rig_turned``: the whole oscillator is turned on the carriage. ``struts_offset``: the struts'
    mean positions differ (a turntable's mean angle is the drift). ``model_turned``: the model is
    turned on its struts.
    """

    RIG_TURNED = "rig_turned"
    STRUTS_OFFSET = "struts_offset"
    MODEL_TURNED = "model_turned"


@dataclass(frozen=True)
class Arrangement:
    """What a rig of two struts leaves open, each with its default."""

    joint: Joint = Joint.SLIDES_ON_MODEL
    pivot: Pivot = Pivot.AFT
    gauges: Gauges = Gauges.MODEL
    drift_by: DriftBy = DriftBy.RIG_TURNED
