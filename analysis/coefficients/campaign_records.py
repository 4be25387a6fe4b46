"""What a campaign's result is made of, row by row: plain frozen records that a file can hold."""

from dataclasses import dataclass


@dataclass(frozen=True)
class CoefficientEntry:
    """One value of a campaign's table: its name, method, and range of validity.

    Attributes
    ----------
    name
        Of the coefficient: ``a33``, ``Z_wdot``, ``Y_vvv``, ``X_rr`` ...
    method
        How it was determined: :data:`LINEAR`, :data:`ZERO_FREQUENCY`, or what
        :mod:`analysis.coefficients.cycle_fit` calls its own.
    frequency_hz
        0 for static runs and for what was extrapolated to zero frequency; NaN where several
        frequencies share the value.
    translation_amplitude_m, rotation_amplitude_rad
        Largest of the runs (amplitudes, not strokes).
    retained
        Hydrodynamic part of the load over the largest part that was subtracted; below 0.1
        significant digits are lost. NaN where nothing was subtracted.
    misfit
        Residual over what scatter leads to expect; NaN without any left over.
    """

    name: str
    unit: str
    method: str
    frequency_hz: float
    speed_m_s: float
    translation_amplitude_m: float
    rotation_amplitude_rad: float
    runs: tuple[str, ...]
    retained: float
    misfit: float


LINEAR = "linear"
HIGHER_ORDER = "higher order, several runs"
ZERO_FREQUENCY = "zero frequency"
JOINT = "all lines and runs"
ROLL_DECAY = "roll decay"


@dataclass(frozen=True)
class ConsistencyCheck:
    """Comparison of one quantity determined in two ways.

    Attributes
    ----------
    kind
        ``"two tests"``, ``"static drift"``, ``"restoring"``, ``"single and multiple runs"``.
    first, second
        Where the two values come from.
    difference, standard_uncertainty, degrees_of_freedom
        First less second; uncertainty that both share cancels.
    agrees
        Whether the difference lies within an interval so wide that all checks of a good campaign
        agree together with the campaign's level.
    """

    kind: str
    name: str
    unit: str
    first: str
    second: str
    first_value: float
    second_value: float
    difference: float
    standard_uncertainty: float
    degrees_of_freedom: float
    agrees: bool
    message: str


@dataclass(frozen=True)
class Outlier:
    """A repeat that differs from the other runs of the same motion.

    Attributes
    ----------
    ratio
        Distance from the others over its standard uncertainty.
    limit
        What one run in a hundred such campaigns would exceed by chance.
    """

    run: str
    others: tuple[str, ...]
    load: str
    ratio: float
    limit: float
    message: str


@dataclass(frozen=True)
class FormChoice:
    """Which non-linear form the data support.

    Attributes
    ----------
    load
        ``force`` or ``moment``.
    forms
        Those compared, best first.
    parameters, chi_square, aicc, weights
        Of each form: number of coefficients, weighted squares of the residuals (not over-
        dispersed: see ``dispersion``), Akaike's criterion for few data, and its weight.
    fitted
        The form that is taken: linear unless another is supported as many times better as
        :data:`analysis.coefficients.form_choice.DECIDES` asks.
    dispersion
        Squares left over by the richest form for each degree of freedom, at least 1: the others'
        are divided by it, so that a model that fits nowhere does not seem to decide.
    verdict
        A form, or ``"not separable"``.
    evidence_ratio
        Of the best form over the next that is not contained in the verdict.
    """

    load: str
    runs: tuple[str, ...]
    forms: tuple[str, ...]
    parameters: tuple[int, ...]
    chi_square: tuple[float, ...]
    aicc: tuple[float, ...]
    weights: tuple[float, ...]
    dispersion: float
    verdict: str
    fitted: str
    evidence_ratio: float
    message: str


@dataclass(frozen=True)
class OtherArrangement:
    """How the coefficients change if the rig was arranged otherwise than stated.

    Attributes
    ----------
    key, stated, other
        Of ``[oscillator]``: the key, what it is stated to be, and the alternative.
    evidence_ratio
        Likelihood of the recordings under the alternative over that under what is stated; NaN
        where they were not compared.
    largest
        Largest move of any value under the alternative, over its half-width.
    coefficients, moves
        Those that it moves by more than their half-width, the largest move of each first, and how
        many half-widths that is.
    verdict
        One of those in :mod:`analysis.coefficients.arrangements`.
    """

    key: str
    stated: str
    other: str
    evidence_ratio: float
    largest: float
    coefficients: tuple[str, ...]
    moves: tuple[float, ...]
    verdict: str
    message: str


@dataclass(frozen=True)
class Missing:
    """A coefficient that was asked for or expected, and that these runs do not determine."""

    name: str
    message: str


@dataclass(frozen=True)
class ReferenceRow:
    """A value beside that of a reference table.

    Attributes
    ----------
    reference
        Name of the table: strip theory, a panel method, CFD.
    difference
        Measured less reference.
    within
        Whether the reference lies within the measured interval, widened by ``allowance``.
    """

    name: str
    unit: str
    frequency_hz: float
    speed_m_s: float
    reference: str
    measured: float
    half_width: float
    expected: float
    difference: float
    allowance: float
    within: bool
