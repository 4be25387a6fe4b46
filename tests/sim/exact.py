"""The simulated rig and the exact rig of ``tests/exact`` with one and the same hull."""

import math
from dataclasses import replace

import numpy as np

from hardware.description.arrangement import Arrangement, Joint
from hardware.description.body import Body
from hardware.description.oscillator import Oscillator, Plane, Range
from hardware.description.setpoint import Medium, SetPoint
from sim.acquisition.channels import Acquisition
from sim.model.parameters import HullCoefficients
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.rig import SimulatedRig
from tests.exact.hull import polynomial
from tests.exact.rig import ExactBody, ExactRig

FREQUENCY_HZ, SPEED_M_S, HALF_M = 0.3, 1.2, 0.5
BODY = Body(78.0, 14.0, 0.03, 0.02)
UNDER_WATER = replace(BODY, displaced_kg=71.0, buoyancy_x_m=0.05, buoyancy_z_m=-0.03)
HORIZONTAL = {
    "X_u": -1.5, "X_uu": -5.5, "X_vr": 50.0, "X_vv": -12.0, "X_rr": 4.0,
    "Y_vdot": -110.0, "Y_v": -120.0, "Y_rdot": -3.0, "Y_r": 25.0,
    "Y_vvv": -600.0, "Y_vvr": 80.0, "Y_vrr": -60.0, "Y_rrr": 40.0,
    "Y_v|v|": -300.0, "Y_v|r|": 20.0, "Y_r|v|": -35.0, "Y_r|r|": 9.0,
    "N_vdot": -4.0, "N_v": -45.0, "N_rdot": -18.0, "N_r": -30.0,
    "N_vvv": -70.0, "N_vvr": -50.0, "N_vrr": 20.0, "N_rrr": -25.0,
    "N_v|v|": -30.0, "N_v|r|": 8.0, "N_r|v|": -12.0, "N_r|r|": -20.0,
}  # fmt: skip
VERTICAL = {
    name.replace("v", "w").replace("r", "q").replace("Y_", "Z_").replace("N_", "M_"): value
    for name, value in HORIZONTAL.items()
}
RESTORING = {
    Plane.HORIZONTAL: ((30.0, 12.0), (-8.0, 60.0)),  # of a cable, say
    Plane.VERTICAL: ((5600.0, 300.0), (250.0, 1900.0)),
}
TERMS = {Plane.HORIZONTAL: HORIZONTAL, Plane.VERTICAL: VERTICAL}


def simulated(plane: Plane, arrangement: Arrangement, body: Body = BODY) -> SimulatedRig:
    """Return a rig without noise, limits or play, whose hull has a term of each kind."""
    v, r = ("v", "r") if plane is Plane.HORIZONTAL else ("w", "q")
    rows, terms = ("YN" if plane is Plane.HORIZONTAL else "ZM"), TERMS[plane]

    def asked(*factors: str) -> tuple[tuple[float, ...], ...]:
        return tuple(tuple(-terms[f"{row}_{one}"] for one in factors) for row in rows)

    cubic = asked(v * 3, v * 2 + r, v + r * 2, r * 3)
    quadratic = asked(f"{v}|{v}|", f"{v}|{r}|", f"{r}|{v}|", f"{r}|{r}|")
    return SimulatedRig(
        oscillator=Oscillator(
            plane=plane,
            half_spacing_m=HALF_M,
            frequency_hz=Range(0.1, 2.0),
            eccentricity_m=Range(0.0, 1.0),
            force_per_strut_n=1e6,
            **vars(arrangement),
        ),
        body=body,
        water=HullCoefficients(
            added_mass=asked(f"{v}dot", f"{r}dot"),  # type: ignore[arg-type]  # two by two
            damping=asked(v, r),  # type: ignore[arg-type]
            restoring=RESTORING[plane],
        ),
        cross_flow=CrossFlow(cubic, quadratic),
        surge=SurgeForces(*(terms[f"X_{one}"] for one in ("u", "uu", v * 2, v + r, r * 2))),
        acquisition=Acquisition(),
    ).ideal()


def set_point(arrangement: Arrangement, rotation_rad: float, medium: Medium) -> SetPoint:
    """Return one that sways and turns to some angle."""
    reach = math.sin if arrangement.joint is Joint.SLIDES_ON_RIG else math.tan
    phase, speed = 1.9, SPEED_M_S if medium is Medium.WATER else 0.0
    size = HALF_M * reach(rotation_rad) / math.sin(phase / 2.0)
    return SetPoint(FREQUENCY_HZ, size, phase, speed, medium)


def exact(
    plane: Plane,
    arrangement: Arrangement,
    point: SetPoint,
    drift_rad: float,
    own: Body = BODY,
) -> ExactRig:
    """Return the exact rig of a run: the same hull, and the body that it floats or hangs with."""
    vertical, water = plane is Plane.VERTICAL, point.medium is Medium.WATER
    body = ExactBody(own.mass_kg, own.inertia_kg_m2, own.cg_x_m, own.cg_z_m if vertical else 0.0)
    if water and own.displaced_kg is None:
        body = replace(body, displaced_kg=own.mass_kg, buoyancy_x_m=own.cg_x_m)
    elif water and own.displaced_kg is not None:
        body = replace(
            body,
            displaced_kg=own.displaced_kg,
            buoyancy_x_m=own.buoyancy_x_m,
            buoyancy_across_m=own.buoyancy_z_m,
        )
    size = point.eccentricity_m
    struts = np.array([[0.0, 0.0], [size, size * np.exp(1j * point.strut_phase_rad)]])
    return ExactRig(
        struts,
        point.frequency_hz,
        point.carriage_speed_m_s,
        drift_rad,
        plane,
        HALF_M,
        arrangement,
        body,
        polynomial(TERMS[plane] if water else {}),
        np.array(RESTORING[plane]) if water else np.zeros((2, 2)),
    )
