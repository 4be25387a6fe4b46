"""Air that swings along: what it adds to a gyradius, and taking that off."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from analysis.inertia.corrections import without_entrained_air
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import Assessment, assess
from pmm.inertia.stated_values import given_or_none, stated_value


@dataclass(frozen=True)
class AirTable:
    """The air's added mass.

    Attributes
    ----------
    coefficient
        Added mass over displaced mass in the rotation, by shape: 0.2 to 1 and more across.
    sway_coefficient
        The same athwartships; only yaw by ratio or beats needs it.
    gyradius_m
        Of the displaced volume about the axis; the body's own where left out.
    """

    coefficient: float
    u_coefficient: float = 0.0
    sway_coefficient: float = 0.0
    u_sway_coefficient: float = 0.0
    gyradius_m: float | None = None
    u_gyradius_m: float = 0.0


def air_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the keys without which the displaced air is not known."""
    if "entrained_air" in table:
        for key in ("air_density_kg_m3", "body_density_kg_m3"):
            if not table.get(key):
                yield key, "is missing beside entrained_air: both give the displaced air"


def period_without_air(table: Any, period: Estimate) -> Estimate:
    """Return a period free of the air that the body would drag if it were a point.

    With ``s = 1 + ratio coefficient`` the period about an axis at the depth d is that of a body
    without air whose gyradius k' is ``s k'^2 = k^2 + ratio coefficient a^2``, a of the displaced
    volume, times the root of s.
    """
    air: AirTable | None = table.entrained_air
    if air is None:
        return period
    ratio = table.air_density_kg_m3 / table.body_density_kg_m3
    coefficient = stated_value(air, "coefficient", "entrained_air")
    return derived(
        "period_s",
        lambda period, coefficient: period / sqrt(1.0 + ratio * coefficient),
        "s",
        period=period,
        coefficient=coefficient,
    )


def without_air(
    table: Any,
    assessment: Assessment,
    *,
    depth: Estimate | None = None,
    delayed: Literal["sway_coefficient", "coefficient"] | None = None,
    seed: int = 0,
) -> Assessment:
    """Take the entrained air of a job's file off a gyradius; it stays where the file has none.

    Parameters
    ----------
    depth
        Of the centre of gravity below the axis of the swing, which the air swings about too.
    delayed
        The air's coefficient by which what the gyradius was compared with is delayed as well: sway,
        or a swing of the body as a point.
    """
    air: AirTable | None = table.entrained_air
    if air is None:
        return assessment
    ratio = table.air_density_kg_m3 / table.body_density_kg_m3
    inputs = {
        "gyradius_in_air_m": assessment.budget.result,
        "coefficient": stated_value(air, "coefficient", "entrained_air"),
        "depth_m": depth or exactly(0.0, "m"),
    }
    if delayed == "sway_coefficient":
        inputs[delayed] = stated_value(air, delayed, "entrained_air")
    air_gyradius = given_or_none(air, "gyradius_m", "entrained_air")
    if air_gyradius is not None:
        inputs["air_gyradius_m"] = air_gyradius

    def gyradius(
        gyradius_in_air_m: Value, coefficient: Value, depth_m: Value, **more: Value
    ) -> Any:
        delays = {"coefficient": coefficient, **more}
        square = gyradius_in_air_m * gyradius_in_air_m
        square = square * (1.0 + ratio * (delays[delayed] if delayed else 0.0))
        volume = more.get("air_gyradius_m", gyradius_in_air_m)
        about = sqrt(volume * volume + depth_m * depth_m)
        # of 1 kg of body, so the displaced air is the ratio and the inertia the square
        return sqrt(without_entrained_air(square, ratio, coefficient, about))

    return assess(assessment.budget.name, gyradius, inputs, unit="m", seed=seed)
