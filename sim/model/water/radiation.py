"""The water's linear reaction with its memory: infinite-frequency added mass and a state space."""

from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError


class _RowsOrArray:
    """Tells who validates a file that rows of numbers do for a matrix."""

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(_rows_of)


def _rows_of(values: object) -> FloatArray:
    """Return rows of numbers as an array; what is refused is a ``ValueError``."""
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(
            "has to be a list of rows of numbers, all equally long, as [[1.0, 0.0], [0.0, 1.0]]"
        ) from error


@dataclass(frozen=True, eq=False)
class Radiation:
    """Linear loads of the water on the model, constant added mass and memory together.

    With v the velocity of the model through the water (translation, rotation) in the axes of the
    plane (heave down and pitch bow up, or sway to starboard and yaw bow to starboard),

        xi' = state_matrix xi + input_matrix v        mu = output_matrix xi
        loads of the water on the hull = -(added_mass_infinite v' + mu)

    so that the struts exert ``added_mass_infinite v' + mu`` (Cummins' equation, its convolution
    written as n states). With n = 0 the added mass does not depend on the frequency and there is no
    damping. The matrices are kept as read-only copies.

    Attributes
    ----------
    added_mass_infinite
        Added mass at infinite frequency, shape ``(2, 2)``: kg and kg m; kg m and kg m^2.
    state_matrix
        Shape ``(n, n)``, 1/s; all eigenvalues have a negative real part.
    input_matrix
        Shape ``(n, 2)``.
    output_matrix
        Shape ``(2, n)``.
    onset_s
        Time from the start of a run before which a state has no input, shape ``(n,)``: what comes
        back from afar is not there yet. All that is said by frequency is of long after it.
    aboard
        1 for a state of water that the model carries along, 0 for one of water that it passes,
        shape ``(n,)``: an angle of attack is none to what is on board, which is there in air too.

    Raises
    ------
    ConfigurationError
        If a shape does not fit, a value is not finite, ``aboard`` is neither 0 nor 1, or the state
        matrix is not stable.
    """

    added_mass_infinite: Annotated[FloatArray, _RowsOrArray()]
    state_matrix: Annotated[FloatArray, _RowsOrArray()]
    input_matrix: Annotated[FloatArray, _RowsOrArray()]
    output_matrix: Annotated[FloatArray, _RowsOrArray()]
    onset_s: Annotated[FloatArray, _RowsOrArray()] = field(default_factory=lambda: np.zeros(0))
    aboard: Annotated[FloatArray, _RowsOrArray()] = field(default_factory=lambda: np.zeros(0))

    __pydantic_config__: ClassVar = {"extra": "forbid", "arbitrary_types_allowed": True}

    def __post_init__(self) -> None:
        for name in ("added_mass_infinite", "state_matrix", "input_matrix", "output_matrix"):
            object.__setattr__(self, name, _numbers(name, getattr(self, name)))
        n = len(self.state_matrix) if self.state_matrix.ndim else 0
        shapes = {
            "added_mass_infinite": (2, 2),
            "state_matrix": (n, n),
            "input_matrix": (n, 2),
            "output_matrix": (2, n),
        }
        for name, shape in shapes.items():
            object.__setattr__(self, name, _checked(name, getattr(self, name), shape))
        for name in ("onset_s", "aboard"):
            given = _numbers(name, getattr(self, name))
            of_states = _checked(name, given if given.size else np.zeros(n), (n,))
            object.__setattr__(self, name, of_states)
        for value in self.aboard[~np.isin(self.aboard, (0.0, 1.0))]:
            raise ConfigurationError(
                f"aboard has {value:g}; of each state it says 0 (the model passes that water) or 1 "
                "(it carries it along)"
            )
        fastest_growth = _fastest_growth(n, self.state_matrix.tobytes())
        if fastest_growth >= 0.0:
            raise ConfigurationError(
                f"state_matrix has an eigenvalue with real part {fastest_growth:.3g} 1/s where all "
                f"must be negative: the memory would not fade; fit it again with fewer states"
            )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Radiation):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[bytes, ...]:
        # Adding 0.0 makes -0.0 the same bytes as 0.0.
        return tuple((getattr(self, item.name) + 0.0).tobytes() for item in fields(self))

    @property
    def states(self) -> int:
        """Number n of states of the memory."""
        return int(self.state_matrix.shape[0])

    @property
    def passing_matrix(self) -> FloatArray:
        """What of ``input_matrix`` takes the velocity that comes of the way, shape ``(n, 2)``."""
        return self.input_matrix * (1.0 - self.aboard)[:, None]

    @property
    def on_board(self) -> "Radiation | None":
        """The water that the model carries along by itself; ``None`` if there is none."""
        at = np.flatnonzero(self.aboard)
        if not at.size:
            return None
        return Radiation(
            np.zeros((2, 2)),
            self.state_matrix[np.ix_(at, at)],
            self.input_matrix[at],
            self.output_matrix[:, at],
            self.onset_s[at],
            self.aboard[at],
        )

    def memory(self, omega_rad_s: ArrayLike) -> ComplexArray:
        """Return K(i w) = B(w) + i w (A(w) - A_inf), shape ``(*omega.shape, 2, 2)``."""
        omega = np.asarray(omega_rad_s, dtype=np.float64)
        resolvent = 1j * omega[..., None, None] * np.eye(self.states) - self.state_matrix
        inputs = np.broadcast_to(self.input_matrix, (*omega.shape, self.states, 2))
        memory: ComplexArray = self.output_matrix @ np.linalg.solve(resolvent, inputs)
        return memory

    def added_mass(self, omega_rad_s: ArrayLike) -> FloatArray:
        """Return A(w), shape ``(*omega.shape, 2, 2)``; at w = 0 its limit."""
        omega = np.asarray(omega_rad_s, dtype=np.float64)
        # (K(iw) - K(0))/(iw) = -C (iw - A)^-1 (-A)^-1 B, which stays finite at w = 0.
        resolvent = 1j * omega[..., None, None] * np.eye(self.states) - self.state_matrix
        at_rest = np.linalg.solve(self.state_matrix, self.input_matrix)
        inputs = np.broadcast_to(at_rest, (*omega.shape, self.states, 2))
        memory: FloatArray = (self.output_matrix @ np.linalg.solve(resolvent, inputs)).real
        return self.added_mass_infinite + memory

    def damping(self, omega_rad_s: ArrayLike) -> FloatArray:
        """Return B(w), shape ``(*omega.shape, 2, 2)``."""
        return self.memory(omega_rad_s).real

    def at(self, time_s: float) -> "Radiation":
        """Return the memory with the inputs that it has so long after the start of a run."""
        heard = self.onset_s <= time_s
        if heard.all():
            return self
        return replace(self, input_matrix=self.input_matrix * heard[:, None])

    def joined(
        self,
        state_matrix: ArrayLike,
        input_matrix: ArrayLike,
        output_matrix: ArrayLike,
        onset_s: float = 0.0,
        *,
        aboard: bool = False,
    ) -> "Radiation":
        """Return the memory with further states beside these: the loads of both add up."""
        count, added = self.states, np.asarray(state_matrix)
        matrix = np.zeros((count + len(added), count + len(added)))
        matrix[:count, :count], matrix[count:, count:] = self.state_matrix, added
        ones = np.ones(len(added))
        return replace(
            self,
            state_matrix=matrix,
            input_matrix=np.concatenate([self.input_matrix, input_matrix]),
            output_matrix=np.concatenate([self.output_matrix, output_matrix], axis=1),
            onset_s=np.concatenate([self.onset_s, onset_s * ones]),
            aboard=np.concatenate([self.aboard, aboard * ones]),
        )


def constant(added_mass: ArrayLike) -> Radiation:
    """Return an added mass, shape ``(2, 2)``, that does not depend on the frequency: no memory."""
    empty = np.zeros((0, 2))
    return Radiation(np.asarray(added_mass), np.zeros((0, 0)), empty, empty.T)


@lru_cache(maxsize=512)
def _fastest_growth(states: int, matrix: bytes) -> float:
    """Return the largest real part of a matrix's eigenvalues; runs of a campaign share theirs."""
    values = np.frombuffer(matrix, np.float64).reshape(states, states)
    return float(max(np.linalg.eigvals(values).real, default=-1.0))


def _numbers(name: str, values: ArrayLike) -> FloatArray:
    """Return a matrix given as an array, or as a list of rows."""
    try:
        return _rows_of(values)
    except ValueError as error:
        raise ConfigurationError(f"{name} {error}") from error


def _checked(name: str, array: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    if array.size == 0 and 0 in shape:
        array = array.reshape(shape)
    if array.shape != shape:
        raise ConfigurationError(f"{name} has shape {array.shape} where {shape} is needed")
    if not np.isfinite(array).all():
        raise ConfigurationError(f"{name} has values that are not finite")
    array.setflags(write=False)
    return array
