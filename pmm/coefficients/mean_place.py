"""What the means of the struts' displacements say of the model's place, beside what is stated."""

import math
from collections.abc import Iterator
from typing import Final

from analysis.coefficients.body_axes import at_order
from analysis.coefficients.strut_cycle import StrutCycle
from hardware.description.arrangement import DriftBy, Joint
from hardware.description.channels import DISPLACEMENTS
from hardware.description.flags import Flag, Severity

_TURNED_RAD: Final = math.radians(0.25)  # moves M_w by a part of a per cent of Z_w
_ALIKE: Final = 0.2  # of the stated angle


def place_flags(struts: StrutCycle) -> Iterator[Flag]:
    """Yield a flag where the means turn the model as the stated drift does, or turn it unsaid."""
    aft, fore = (struts.phasors[at_order(name, 0)].real for name in DISPLACEMENTS)
    table = struts.oscillator.joint is Joint.YAW_TABLE  # its fore displacement is the angle
    turned = abs(fore if table else math.atan2(fore - aft, 2.0 * struts.oscillator.half_spacing_m))
    drift = abs(struts.set_point.drift_rad)
    shown = f"the struts' displacements stand {math.degrees(turned):.3g} deg apart on average"
    offset = struts.oscillator.arrangement.drift_by is DriftBy.STRUTS_OFFSET
    if drift and offset and abs(turned - drift) < _ALIKE * drift:
        message = (
            f"{shown}, and drift_deg is {math.degrees(drift):.3g}: with drift_by = "
            '"struts_offset" both are counted; take the offset out of the displacements'
        )
        yield Flag("drift_twice", Severity.WARNING, message)
    elif not drift and turned > _TURNED_RAD:
        message = (
            f"{shown}: the model is taken to be turned by that; take it out of the recordings, and "
            "state it as drift_deg unless it is the sensors' zero"
        )
        yield Flag("turned_on_average", Severity.NOTE, message)
