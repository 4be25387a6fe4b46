"""All parameters of propeller and rudder of a campaign, with their standard uncertainties."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.steering.inflow import Inflow, inflow, wake_name
from analysis.steering.load_factors import LoadFactors, load_factors
from analysis.steering.observations import Particulars, SteeringRuns
from analysis.steering.propulsion import SelfPropulsion, self_propulsion
from hardware.description.arrays import FloatArray

OF_LOADS: Final = ("1-t_P", "t_R", "a_H", "x_H'")
OF_INFLOW: Final = {"epsilon": "epsilon", "kappa": "kappa", "gamma_R+": "gamma_R+",
                    "gamma_R-": "gamma_R-", "l_R": "l_R'", "delta_0": "delta_0"}  # fmt: skip


@dataclass(frozen=True, eq=False)
class SteeringParameters:
    """Parameters without dimensions (lengths over L), but for delta_0 in rad.

    Attributes
    ----------
    names
        1-t_P, w_P0, t_R, a_H, x_H', epsilon, kappa, gamma_R+ and gamma_R- (by the sign of beta_R),
        l_R', delta_0: those that the runs tell.
    covariance
        Of the scatter of all runs, larger by the residuals' excess (Birge's ratio) where there is
        one.
    missing
        By name, what runs would tell a parameter.
    misfit
        Root of the weighted squares per degree of freedom: of the loads, and of thrust and normal
        force. Far above 1 the method's form is not the ship's, or uncertainties are too small.
    wakes
        Motion u, v, r, then w_P and its standard uncertainty: shape ``(5, conditions)``.
    self_propulsion
        Of each speed on straight course.
    """

    names: tuple[str, ...]
    values: FloatArray
    covariance: FloatArray
    missing: dict[str, str]
    misfit: tuple[float, float]
    wakes: FloatArray
    self_propulsion: tuple[SelfPropulsion, ...]

    @property
    def standard_uncertainty(self) -> FloatArray:
        """Of each value."""
        return np.sqrt(np.diagonal(self.covariance))

    def __getitem__(self, name: str) -> float:
        """Return one value."""
        return float(self.values[self.names.index(name)])


def identified(
    runs: SteeringRuns, particulars: Particulars, towing_force_n: float = 0.0
) -> SteeringParameters:
    """Return all parameters that the runs tell.

    Parameters
    ----------
    towing_force_n
        That the self-propulsion point has besides the thrust: the friction's deduction F_D.

    Raises
    ------
    DataError
        If the runs do not tell the factors of the loads, or parameters cannot be told apart.
    """
    loads, flow = load_factors(runs), inflow(runs, particulars)
    ratios = tuple(_ratio(fit) for fit in (loads, flow))
    values, slopes, names = _parameters(runs, particulars, loads, flow, ratios)
    scaled = runs.following_slopes(slopes)
    wake = _wakes(runs, flow, ratios[1])
    points = tuple(
        self_propulsion(k, runs, particulars, loads, flow, max(1.0, *ratios), towing_force_n)
        for k in runs.straight_runs
    )
    misfits = (ratios[0], ratios[1])
    return SteeringParameters(names, values, scaled @ scaled.T, flow.missing, misfits, wake, points)


def _ratio(fit: LoadFactors | Inflow) -> float:
    return float(np.sqrt(fit.squares / fit.spare)) if fit.spare > 0 else np.nan


def _parameters(
    runs: SteeringRuns,
    particulars: Particulars,
    loads: LoadFactors,
    flow: Inflow,
    ratios: tuple[float, ...],
) -> tuple[FloatArray, FloatArray, tuple[str, ...]]:
    """Return values, their slopes by the measured numbers, and names, in the order of a table."""
    thrust, steered, across, about = loads.values[:4]
    force_increase = across - 1.0
    place = (about - particulars.rudder_x_m) / force_increase
    length = particulars.length_m
    by_factors = np.zeros((4, 4))
    by_factors[0, 0], by_factors[1, 1], by_factors[2, 2] = 1.0, -1.0, 1.0
    by_factors[3, 2:] = -place / force_increase / length, 1.0 / force_increase / length
    of_loads = (thrust, 1.0 - steered, force_increase, place / length)
    load_slopes = np.fmax(1.0, ratios[0]) * np.tensordot(by_factors, loads.by_data[:4], 1)
    flow_slopes = np.fmax(1.0, ratios[1]) * flow.by_data
    rows = [(OF_LOADS[0], of_loads[0], load_slopes[0])]
    straight = [flow.names.index(wake_name(int(k))) for k in runs.straight_runs]
    if straight:
        share = np.full(len(straight), 1.0 / len(straight))
        rows.append(
            (
                "w_P0",
                float(share @ flow.values[straight]),
                np.tensordot(share, flow_slopes[straight], 1),
            )
        )
    rows += list(zip(OF_LOADS[1:], of_loads[1:], load_slopes[1:], strict=True))
    for name, parameter in OF_INFLOW.items():
        if name in flow.names:
            k, unit = flow.names.index(name), length if name == "l_R" else 1.0
            rows.append((parameter, flow.values[k] / unit, flow_slopes[k] / unit))
    names, values, slopes = zip(*rows, strict=True)
    return np.array(values), np.array(slopes), tuple(names)


def _wakes(runs: SteeringRuns, flow: Inflow, ratio: float) -> FloatArray:
    wake_rows = [flow.names.index(wake_name(k)) for k in range(runs.conditions)]
    followed = runs.following_slopes(flow.by_data[wake_rows])
    u = np.fmax(1.0, ratio) * np.sqrt((followed**2).sum(axis=1))
    return np.concatenate((runs.motions, [flow.values[wake_rows]], [u]))
