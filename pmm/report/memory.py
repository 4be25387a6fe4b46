"""The water's memory that a campaign at rest tells: what was found, and its tables."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from analysis.coefficients.linear_fit import DISAGREE
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Content, Data, Note, Notes, Table, Text, number
from pmm.document.notation import NOT_KNOWN, rounded, written

if TYPE_CHECKING:
    from analysis.memory.result import MeasuredMemory, Order

_CHOICE: Final = (
    "The least criterion is taken; a dash where more squares are left over already without the "
    "condition that no energy comes from the water."
)
UNITS: Final = (("kg", "N s/m"), ("kg m", "N s"), ("kg m2", "N m s"))
_OF_RESIDUES: Final = ("N/m", "N", "N m")
_SLOW: Final = 1e-3  # of the middle frequency: slow motion within a millionth


@dataclass(frozen=True)
class _Pole:
    """A real pole, or a pair: rate of fading and frequency (rad/s) with half-widths, residues."""

    rate: float
    rate_half: float
    turn: float
    turn_half: float
    residues: tuple[complex, ...]


@dataclass(frozen=True)
class _End:
    """A in slow motion and at infinite frequency, and B_0, of one element; with half-widths."""

    name: str
    slow: tuple[float, float]
    infinite: tuple[float, float]
    steady: tuple[float, float]
    units: tuple[str, str]


def memory_contents(outcome: CampaignOutcome) -> Iterator[Content]:
    """Yield what was found of the memory, where there are enough frequencies at rest."""
    for memory in outcome.memories:
        yield Text(("", *_sentences(memory)))
        yield Notes([Note("warning", text) for text in _doubts(memory)])
        yield from _tables(memory, outcome.result.level)


def memory_data(outcome: CampaignOutcome) -> Data:
    """Return all of it for programs."""
    return Data("memory", [_data(memory, outcome.result.level) for memory in outcome.memories])


def _sentences(memory: "MeasuredMemory") -> Iterator[str]:
    low, high = band_hz(memory)
    where = f"{memory.measured.motions} at rest from {low:.3g} to {high:.3g} Hz"
    if not memory.chosen.states:
        yield f"memory  {where}: the coefficients do not change with the frequency: no memory"
        return
    yield (
        f"memory  {where}: {memory.chosen.states} states, "
        f"chi-square {memory.chosen.chi_square:.3g} of "
        f"{memory.chosen.freedom}; beyond these frequencies it is extrapolated"
    )


def _skew(memory: "MeasuredMemory", level: float) -> tuple[str, ...]:
    skew = memory.measured.skew
    if not skew.values[0]:
        return ()
    first = memory.measured.names[1][0][1:]
    text = rounded(float(skew.values[0]), float(skew.half_width(level)[0]))
    return (f"B_0 of {first} is {text} N s above, that of {first[::-1]} as much below.",)


def _doubts(memory: "MeasuredMemory") -> Iterator[str]:
    if memory.misfits:
        yield (
            f"memory of {memory.measured.motions}: what is left is {memory.misfit:.2g} times what "
            f"scatter explains (limit {DISAGREE:g}), and intervals are wider by it: the values "
            "have faults of their own, or the hull is not linear"
        )
    if memory.contradicted:
        yield (
            f"memory of {memory.measured.motions}: no water that only takes energy has added mass "
            f"and damping as measured (chi-square {memory.chosen.chi_square:.3g}, without that "
            f"condition {memory.chosen.unconditioned:.3g}); look for a lag of a channel or a wrong "
            "restoring"
        )
    if memory.measured.coupling_differs:
        yield (
            f"memory of {memory.measured.motions}: the coupling of one way is not that of the "
            f"other ({memory.measured.unlike:.2g} standard uncertainties), as it is at rest; "
            "their mean was fitted; look at the point of reference and at the yaw or pitch runs"
        )


def band_hz(memory: "MeasuredMemory") -> tuple[float, float]:
    """Return the lowest and the highest measured frequency, Hz."""
    omega = memory.measured.omega_rad_s / (2.0 * math.pi)
    return float(omega[0]), float(omega[-1])


def _poles(memory: "MeasuredMemory", level: float) -> list[_Pole]:
    poles, halves = memory.poles, memory.rates().half_width(level)
    turns = np.zeros(poles.size)
    turns[poles.imag != 0.0] = halves[poles.size :]
    rows = zip(-poles.real, halves[: poles.size], poles.imag, turns, memory.residues.T, strict=True)
    return [
        _Pole(float(rate), float(half), float(turn), float(turn_half), tuple(residues.tolist()))
        for rate, half, turn, turn_half, residues in rows
    ]


def _ends(memory: "MeasuredMemory", level: float) -> list[_End]:
    ends, slow = memory.ends(), memory.curves(np.array([_SLOW * memory.middle]))
    values = [
        list(zip(vector.values.tolist(), vector.half_width(level).tolist(), strict=True))
        for vector in (slow, ends)
    ]
    pairs = zip(memory.measured.names, memory.measured.elements, strict=True)
    return [
        _End(
            names[0][1:], values[0][2 * k], values[1][2 * k], values[1][2 * k + 1], UNITS[sum(pair)]
        )
        for k, (names, pair) in enumerate(pairs)
    ]


_ENDS: Final[tuple[Column[_End], ...]] = (
    Column("element", lambda row: row.name),
    Column("A in slow motion", lambda row: rounded(*row.slow), number=True),
    Column("A at infinite frequency", lambda row: rounded(*row.infinite), number=True),
    Column("", lambda row: row.units[0]),
    Column("steady damping B_0", lambda row: rounded(*row.steady), number=True),
    Column("", lambda row: row.units[1]),
)
_ORDERS: "Final[tuple[Column[Order], ...]]" = (
    number("states", "states"),
    number("chi-square", "chi_square", written(".4g")),
    number("without the condition", "unconditioned", written(".4g")),
    number("degrees of freedom", "freedom"),
    number("criterion", "criterion", written(".4g")),
)


def _tables(memory: "MeasuredMemory", level: float) -> Iterator[Content]:
    title = f"Memory of the water, {memory.measured.motions}"
    if memory.chosen.states:
        yield Table(f"{title}: poles", _pole_columns(memory), _poles(memory, level), titled=True)
    notes = _skew(memory, level)
    yield Table(f"{title}: ends", _ENDS, _ends(memory, level), titled=True, notes=notes)
    yield Table(
        f"{title}: numbers of states", _ORDERS, memory.orders, titled=True, notes=(_CHOICE,)
    )


def _pole_columns(memory: "MeasuredMemory") -> list[Column[_Pole]]:
    def turned(row: _Pole) -> str:
        return rounded(row.turn, row.turn_half) if row.turn else NOT_KNOWN

    def residue(k: int) -> Column[_Pole]:
        pair, names = memory.measured.elements[k], memory.measured.names[k]
        return Column(
            f"residue {names[0][1:]}",
            lambda row: _complex(row.residues[k]),
            unit=_OF_RESIDUES[sum(pair)],
            number=True,
        )

    return [
        Column("fades at", lambda row: rounded(row.rate, row.rate_half), unit="1/s", number=True),
        Column("turns at", turned, unit="rad/s", number=True),
        Column("time constant", lambda row: f"{1.0 / row.rate:.3g}", unit="s", number=True),
        *(residue(k) for k in range(len(memory.measured.elements))),
    ]


def _complex(value: complex) -> str:
    return f"{value.real:.4g}{value.imag:+.4g}i" if value.imag else f"{value.real:.4g}"


def _data(memory: "MeasuredMemory", level: float) -> dict[str, Any]:
    radiation, measured = memory.radiation, memory.measured
    curves = memory.curves(measured.omega_rad_s)
    arrays = {
        "measured": measured.uncertain.values,
        "measured_half_width": measured.uncertain.half_width(level),
        "fitted": curves.values,
        "fitted_half_width": curves.half_width(level),
    }
    return {
        "motions": measured.motions,
        "band_hz": band_hz(memory),
        "frequencies_hz": measured.omega_rad_s / (2.0 * math.pi),
        "states": memory.chosen.states,
        "orders": memory.orders,
        "poles": [
            {
                "real_1_s": -row.rate,
                "imag_rad_s": row.turn,
                "half_widths": (row.rate_half, row.turn_half),
                "residues": [(residue.real, residue.imag) for residue in row.residues],
            }
            for row in _poles(memory, level)
        ],
        "elements": [
            {
                "name": row.name,
                "added_mass_slow": row.slow,
                "added_mass_infinite": row.infinite,
                "steady_damping": row.steady,
            }
            for row in _ends(memory, level)
        ],
        "curves": {
            names[kind]: {key: measured.shaped(values)[k, kind] for key, values in arrays.items()}
            for k, names in enumerate(measured.names)
            for kind in (0, 1)
        },
        "state_space": {
            "added_mass_infinite": radiation.added_mass_infinite,
            "steady_damping": memory.damping_matrix(),
            "state_matrix": radiation.state_matrix,
            "input_matrix": radiation.input_matrix,
            "output_matrix": radiation.output_matrix,
        },
        "doubts": list(_doubts(memory)),
    }
