"""Depth of the centre of gravity from an inclining weight (eqs 20 and 21)."""

from analysis.inertia.elementary_functions import Value, tan
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess


def incline_depth(
    weight_kg: Value, mass_kg: Value, lever_m: Value, drop_m: Value, tilt_rad: Value
) -> Value:
    """Depth below the suspension point, weight at one end (eq 20).

    Parameters
    ----------
    lever_m, drop_m
        ``L_s`` and ``b_s``: horizontal distance of the weight's suspension and its depth below the
        point, both with the body level.
    """
    return weight_kg / mass_kg * (lever_m / tan(tilt_rad) - drop_m)


def incline_depth_both_ends(
    weight_kg: Value,
    mass_kg: Value,
    length_m: Value,
    stern_drop_m: Value,
    bow_drop_m: Value,
    stern_tilt_rad: Value,
    bow_tilt_rad: Value,
) -> Value:
    """Depth with the weight at the stern and then at the bow (eq 21).

    Only the distance of both weights' suspensions (``length_m``) is needed, not the point's place.
    """
    stern, bow = tan(stern_tilt_rad), tan(bow_tilt_rad)
    moment = length_m - stern_drop_m * stern - bow_drop_m * bow
    return weight_kg / mass_kg * moment / (stern + bow)


def incline_from_one_end(
    weight: Estimate,
    mass: Estimate,
    lever: Estimate,
    drop: Estimate,
    tilt: Estimate,
    *,
    seed: int = 0,
) -> Assessment:
    """Return the depth with its budget.

    Raises
    ------
    ConfigurationError
        For a mass, weight, lever or tilt that is not above zero.
    """
    require_positive("incline", weight_kg=weight, mass_kg=mass, lever_m=lever, tilt_rad=tilt)
    inputs = {
        "weight_kg": weight,
        "mass_kg": mass,
        "lever_m": lever,
        "drop_m": drop,
        "tilt_rad": tilt,
    }
    return assess("l_2", incline_depth, inputs, unit="m", seed=seed)


def incline_from_both_ends(
    weight: Estimate,
    mass: Estimate,
    length: Estimate,
    drops: tuple[Estimate, Estimate],
    tilts: tuple[Estimate, Estimate],
    *,
    seed: int = 0,
) -> Assessment:
    """Return the depth from both ends with its budget; pairs are stern, bow.

    Raises
    ------
    ConfigurationError
        For a mass, weight, length or tilt that is not above zero.
    """
    require_positive("incline", weight_kg=weight, mass_kg=mass, length_m=length)
    require_positive("incline", stern_tilt_rad=tilts[0], bow_tilt_rad=tilts[1])
    inputs = {
        "weight_kg": weight,
        "mass_kg": mass,
        "length_m": length,
        "stern_drop_m": drops[0],
        "bow_drop_m": drops[1],
        "stern_tilt_rad": tilts[0],
        "bow_tilt_rad": tilts[1],
    }
    return assess("l_2", incline_depth_both_ends, inputs, unit="m", seed=seed)
