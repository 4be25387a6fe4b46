"""How a rig is arranged, in the words of a campaign file."""

from itertools import product

from tests.sealed.generator.parameters import FloatArray, P

JOINTS, PIVOTS, GAUGES = ("slides_on_model", "slides_on_rig"), ("aft", "fore"), ("model", "rig")
DRIFTS = ("rig_turned", "struts_offset", "model_turned")
_DRIFT = dict(zip(DRIFTS, (P.RIG_TURNED, P.STRUTS_OFFSET, P.MODEL_TURNED), strict=True))
ARRANGED = tuple(product(JOINTS, PIVOTS, GAUGES))


def arranged(p: FloatArray, joint: str, pivot: str, gauges: str) -> FloatArray:
    """Return the parameters of a rig in this arrangement."""
    q = p.copy()
    q[P.SLIDES_ON_RIG] = float(joint == "slides_on_rig")
    q[P.FORE_PIVOT] = float(pivot == "fore")
    q[P.RIG_GAUGES] = float(gauges == "rig")
    return q


def drifted(p: FloatArray, drift_rad: float, by: str) -> None:
    """Set the drift of a run, bow to starboard (up) positive, in the rig's own way."""
    for place in _DRIFT.values():
        p[place] = 0.0
    p[_DRIFT[by]] = -p[P.INCIDENCE] * drift_rad
