"""Write ``plan-checks.md``: ``python docs/plan_checks.py``. All of it comes from the code."""

from pathlib import Path

from pmm.plan.check import Check
from pmm.plan.check_table import CHECKS, STATIC_ANGLE

HERE = Path(__file__).parent
_HEAD = """\
# What a plan is checked for

Made by `python docs/plan_checks.py` from the table that `pmm plan check` reads, `pmm/plan/check_table.py`. How findings are told: [plans](plans.md#what-is-checked).

The pages of ITTC 7.5-02-06-02 (Captive Model Test) were not at hand: that it asks for a number, and the bounds of w L / U and w U / g, are told at second hand. *No limit stated* means that none is known to this project, not that there is none. w is the circular frequency, L the length, B the beam, T the draught, W the tank's width, h its depth. Angles and rates are those of the exact motion.

| quantity | verdict and limit | source | why, what to do | half the limit, twice the limit |
|---|---|---|---|---|
"""  # noqa: E501
_WORDS = {"rotation": "yaw or pitch", "rate": "r", "channel": "a gauge"}
_OF_ANGLES = {"channel": "drift, heel or rudder angle"}


def page() -> str:
    """Return the page as it should be."""
    return _HEAD + "".join(map(_row, CHECKS))


def _row(one: Check) -> str:
    limit = one.limit.format(*one.numbers)
    words = _WORDS | (_OF_ANGLES if one is STATIC_ANGLE else {})
    cells = (one.quantity.format(**words), limit, one.source, one.reason, one.moved)
    return f"| {' | '.join(cells)} |\n"


if __name__ == "__main__":
    (HERE / "plan-checks.md").write_text(page(), encoding="utf-8")
