"""The swing in motion: pivot inertia from the period, and a model's from the difference.

I_P = T^2/(4 pi^2) m g R         I = I_P - m R^2             (eqs 4 to 7)
"""

import math
from dataclasses import dataclass
from functools import partial

from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

SMALL_SHARE = 0.05
FORECAST_LIMIT = 0.05  # of the gyradius, relative standard uncertainty


def pivot_inertia(period_s: Value, mass_kg: Value, cg_m: Value, gravity_m_s2: Value) -> Value:
    """Inertia about the pivot (eq 4): ``cg_m`` below it, in kg m2."""
    return period_s * period_s * mass_kg * gravity_m_s2 * cg_m / (4.0 * math.pi**2)


def inertia_at_cg(period_s: Value, mass_kg: Value, cg_m: Value, gravity_m_s2: Value) -> Value:
    """Inertia about the centre of gravity (eqs 4 and 6), in kg m2."""
    about_pivot = pivot_inertia(period_s, mass_kg, cg_m, gravity_m_s2)
    return about_pivot - mass_kg * cg_m * cg_m


@dataclass(frozen=True)
class SwingState:
    """A swing as it hangs: alone, or with a model.

    Attributes
    ----------
    period, mass, moment, gravity
        Undamped period in s, mass in kg, first moment about the pivot in kg m, and g in m/s2 with
        which that moment rights the swing.
    """

    period: Estimate
    mass: Estimate
    moment: Estimate
    gravity: Estimate

    @property
    def inputs(self) -> dict[str, Estimate]:
        """The state as a budget's inputs."""
        return {
            "period_s": self.period,
            "mass_kg": self.mass,
            "moment_kg_m": self.moment,
            "gravity_m_s2": self.gravity,
        }


@dataclass(frozen=True)
class SwingInertia:
    """Of one state: about the pivot and about its own centre of gravity."""

    about_pivot: Assessment
    about_cg: Assessment


def swing_inertia(state: SwingState, *, seed: int = 0) -> SwingInertia:
    """Return the inertia of what hangs on the knife edges.

    Raises
    ------
    ConfigurationError
        For a period, mass, moment or gravity that is not above zero.
    """
    _check(state)

    def about_pivot(
        period_s: Value, mass_kg: Value, moment_kg_m: Value, gravity_m_s2: Value
    ) -> Value:
        return pivot_inertia(period_s, mass_kg, moment_kg_m / mass_kg, gravity_m_s2)

    def about_cg(period_s: Value, mass_kg: Value, moment_kg_m: Value, gravity_m_s2: Value) -> Value:
        return inertia_at_cg(period_s, mass_kg, moment_kg_m / mass_kg, gravity_m_s2)

    inputs = state.inputs
    return SwingInertia(
        assess("I_P", about_pivot, inputs, unit="kg m2", seed=seed),
        assess("I_CG", about_cg, inputs, unit="kg m2", seed=seed + 1),
    )


def moment_in_air(total_moment_kg_m: Value, tare_moment_kg_m: Value, displaced: float) -> Value:
    """First moment that rights a loaded swing, kg m: less what bears the model in air.

    Parameters
    ----------
    displaced
        Density of the air over the model's.
    """
    return total_moment_kg_m - displaced * (total_moment_kg_m - tare_moment_kg_m)


def model_inertia(
    tare_period_s: Value,
    total_period_s: Value,
    tare_moment_kg_m: Value,
    total_moment_kg_m: Value,
    model_mass_kg: Value,
    gravity_m_s2: Value,
    displaced: float = 0.0,
) -> Value:
    """Inertia of the model about its own centre of gravity: total less swing less ``m d^2``.

    Parameters
    ----------
    total_moment_kg_m
        Of the masses.
    displaced
        See :func:`moment_in_air`.
    """
    about = gravity_m_s2 / (4.0 * math.pi**2)
    righting = moment_in_air(total_moment_kg_m, tare_moment_kg_m, displaced)
    total = total_period_s * total_period_s * righting * about
    tare = tare_period_s * tare_period_s * tare_moment_kg_m * about
    moment = total_moment_kg_m - tare_moment_kg_m
    return total - tare - moment * moment / model_mass_kg


def model_gyradius(model_mass_kg: Value, displaced: float = 0.0, **swing_inputs: Value) -> Value:
    """Gyradius of the model about its own centre of gravity, m; inputs of model_inertia."""
    inertia = model_inertia(model_mass_kg=model_mass_kg, displaced=displaced, **swing_inputs)
    return sqrt(inertia / model_mass_kg)


@dataclass(frozen=True)
class SwingModel:
    """A model measured on the swing.

    Attributes
    ----------
    cg_below_pivot
        Distance of the model's centre of gravity below the pivot, m.
    about_cg, gyradius
        About the axis through the model's own centre of gravity, kg m2 and m.
    share
        Part of the total pivot inertia that is the model's about its own centre of gravity.
    """

    cg_below_pivot: Assessment
    about_cg: Assessment
    gyradius: Assessment
    share: float
    flags: tuple[Flag, ...]


def model_on_swing(
    tare: SwingState,
    loaded: SwingState,
    model_mass: Estimate,
    *,
    displaced: float = 0.0,
    seed: int = 0,
) -> SwingModel:
    """Return the model's centre of gravity and inertia from the swing alone and with it.

    Parameters
    ----------
    displaced
        Density of the air over the model's; the loaded swing's gravity has it in it.

    Raises
    ------
    ConfigurationError
        For a mass, period or moment that is not above zero.
    DataError
        If the loaded swing's inertia does not exceed what position alone makes of the model.
    """
    _check(tare)
    _check(loaded)
    require_positive("model", mass_kg=model_mass)
    inputs = _difference(tare, loaded.period, loaded.moment, model_mass)

    def depth(tare_moment_kg_m: Value, total_moment_kg_m: Value, model_mass_kg: Value) -> Value:
        return (total_moment_kg_m - tare_moment_kg_m) / model_mass_kg

    few = {k: inputs[k] for k in ("tare_moment_kg_m", "total_moment_kg_m", "model_mass_kg")}
    cg = assess("d_M", depth, few, unit="m", seed=seed)
    in_air = {"displaced": displaced}
    inertia = assess("I_M", partial(model_inertia, **in_air), inputs, unit="kg m2", seed=seed + 1)
    _refuse_nothing(inertia.budget.result)
    k = assess("k_M", partial(model_gyradius, **in_air), inputs, unit="m", seed=seed + 2)
    total = pivot_inertia(loaded.period.value, 1.0, loaded.moment.value, loaded.gravity.value)
    share = inertia.budget.result.value / total
    return SwingModel(cg, inertia, k, share, share_flags(share, k.budget.result))


def _refuse_nothing(inertia: Estimate) -> None:
    """Refuse a difference that a gyradius cannot be drawn from."""
    if inertia.value <= 2.3 * inertia.uncertainty:
        raise DataError(
            f"model on the swing: inertia {inertia.value:.3g} +- {inertia.uncertainty:.2g} kg m2 "
            "cannot be told from none; the swing is too heavy for this model: use a bifilar "
            "suspension, or a lighter cradle"
        )


def share_flags(share: float, gyradius: Estimate) -> tuple[Flag, ...]:
    """Flag a model that is too small a part of the total inertia to be measured on this swing."""
    if share >= SMALL_SHARE and gyradius.relative <= FORECAST_LIMIT:
        return ()
    message = (
        f"the model's own inertia is {100 * share:.2g} % of the total (limit "
        f"{100 * SMALL_SHARE:g} %) and its gyradius known to {100 * gyradius.relative:.2g} % "
        f"(limit {100 * FORECAST_LIMIT:g} %): a small difference of large numbers; use a bifilar "
        "suspension or a lighter swing"
    )
    return (Flag("small_difference", Severity.WARNING, message),)


@dataclass(frozen=True)
class SwingForecast:
    """What a test would give, before it is made.

    Attributes
    ----------
    period_s
        Of the loaded swing.
    gyradius
        The model's, with the uncertainty to expect.
    share
        As in :class:`SwingModel`.
    """

    period_s: float
    gyradius: Estimate
    share: float
    worth_swinging: bool
    flags: tuple[Flag, ...]


def forecast_swing(
    tare: SwingState,
    model_mass: Estimate,
    cg_below_pivot_m: float,
    gyradius_m: float,
    *,
    period_scatter_relative: float,
    moment_relative: float,
) -> SwingForecast:
    """Forecast period and uncertainty of a model's gyradius from its design values.

    Parameters
    ----------
    period_scatter_relative, moment_relative
        Relative standard uncertainties to expect of the loaded period and first moment.

    Raises
    ------
    ConfigurationError
        For a mass, distance or gyradius that is not above zero.
    """
    require_positive(
        "forecast",
        mass_kg=model_mass,
        cg_below_pivot_m=cg_below_pivot_m,
        gyradius_m=gyradius_m,
    )
    _check(tare)
    g = tare.gravity.value
    moment = tare.moment.value + model_mass.value * cg_below_pivot_m
    swing = pivot_inertia(tare.period.value, 1.0, tare.moment.value, g)
    inertia = model_mass.value * gyradius_m**2
    total = swing + inertia + model_mass.value * cg_below_pivot_m**2
    period = 2.0 * math.pi * math.sqrt(total / (moment * g))
    loaded_period = Estimate.of(period, period_scatter_relative * period, "s")
    loaded_moment = Estimate.of(moment, moment_relative * moment, "kg m")
    inputs = _difference(tare, loaded_period, loaded_moment, model_mass)
    gyradius = derived("k_M", model_gyradius, "m", **inputs)
    share = inertia / total
    flags = share_flags(share, gyradius)
    return SwingForecast(period, gyradius, share, not flags, flags)


def _difference(
    tare: SwingState, period: Estimate, moment: Estimate, mass: Estimate
) -> dict[str, Estimate]:
    """Return the inputs of :func:`model_inertia`, from the loaded swing's period and moment."""
    return {
        "tare_period_s": tare.period,
        "total_period_s": period,
        "tare_moment_kg_m": tare.moment,
        "total_moment_kg_m": moment,
        "model_mass_kg": mass,
        "gravity_m_s2": tare.gravity,
    }


def _check(state: SwingState) -> None:
    require_positive("swing", **state.inputs)
