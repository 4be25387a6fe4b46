"""The runs on a circle: how each was driven, and what held the model."""

from collections.abc import Sequence
from typing import Final

from analysis.coefficients.steady_turns import SteadyTurn
from pmm.document.content import Column, Table, data_only, number, word
from pmm.document.notation import degrees, rounded, written


def _text(value: float, uncertainty: float) -> str:
    return rounded(value, uncertainty) if uncertainty else f"{value:.4g}"


_CIRCLES: Final[tuple[Column[SteadyTurn], ...]] = (
    word("run", "run"),
    Column("radius", lambda turn: _text(turn.radius_m, turn.u_radius_m), unit="m", number=True),
    Column("r", lambda turn: _text(turn.turn_rate_rad_s, turn.u_turn_rate_rad_s), unit="rad/s",
           number=True),
    number("U", "speed_m_s", written(".4g"), "m/s"),
    Column("drift", lambda turn: degrees(turn.drift_rad), unit="deg", number=True),
    Column("force", lambda turn: rounded(turn.force_n, turn.u_force_n), unit="N", number=True),
    Column("moment", lambda turn: rounded(turn.moment_n_m, turn.u_moment_n_m), unit="N m",
           number=True),
    *data_only("radius_m", "u_radius_m", "turn_rate_rad_s", "u_turn_rate_rad_s", "drift_rad",
               "force_n", "u_force_n", "moment_n_m", "u_moment_n_m"),
)  # fmt: skip


def circle_table(turns: Sequence[SteadyTurn]) -> Table[SteadyTurn]:
    """Return the runs on a circle; empty where there are none."""
    title = "Runs on a circle, loads of what holds the model, one standard uncertainty"
    return Table(title, _CIRCLES, turns, "steady_turns", titled=True)
