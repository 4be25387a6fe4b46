"""What every call returns: a document, and the same as frames, datasets and figures."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, cast

from hardware.description.errors import ConfigurationError
from pmm.document.content import Document
from pmm.document.data import as_data
from pmm.document.page import tables_as_html
from pmm.document.style import render

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CONVENTIONS: Final = (
    "mean + sum over order n of in_phase sin(n theta) + quadrature cos(n theta); theta is the "
    "reference's phase; axes and signs: docs/conventions.md"
)


@dataclass(frozen=True)
class Variable:
    """A column of a frame: its unit, empty where it has none of one, and its meaning."""

    unit: str
    meaning: str


class FigureAxes(tuple["Axes", ...]):
    """The axes of a figure, which a notebook shows."""

    __slots__ = ()

    @property
    def figure(self) -> "Figure":
        """The figure: ``savefig`` writes it."""
        return cast("Figure", self[0].get_figure(root=True))

    def _repr_png_(self) -> bytes:
        return render(self.figure, "png", "")


class Result(ABC):
    """What a command shows, for a program or a notebook.

    In a notebook it shows the command's own tables.
    """

    @cached_property
    @abstractmethod
    def document(self) -> Document:
        """What the command shows: tables, texts, notes and figures."""

    @abstractmethod
    def to_dataframe(self) -> "pd.DataFrame":
        """Return the main table, a row for each value; units are in the names or in a column."""

    @abstractmethod
    def to_dataset(self) -> "xr.Dataset":
        """Return the same with units, meanings and conventions in the attributes."""

    def to_dict(self) -> dict[str, Any]:
        """Return what the command prints with ``--json``."""
        return as_data(self.document)

    @property
    def figures(self) -> tuple[str, ...]:
        """Names of the figures that :meth:`plot` draws."""
        return tuple(figure.name for figure in self.document.figures)

    def plot(self, name: str) -> FigureAxes:
        """Draw a figure and return its axes, which a notebook shows; ``.figure`` is the figure.

        Raises
        ------
        ConfigurationError
            If there is no figure of that name; the message lists those that there are.
        """
        for figure in self.document.figures:
            if figure.name == name:
                return FigureAxes(figure.draw().axes)
        names = ", ".join(self.figures) or "none"
        raise ConfigurationError(f"no figure {name!r}; there are: {names}")

    def _plot_kind(self, kind: str) -> dict[str, FigureAxes]:
        """Draw all figures whose names are of a kind, by name."""
        return {name: self.plot(name) for name in self.figures if kind in name.split("-")}

    def _repr_html_(self) -> str:
        return tables_as_html(self.document)


def dataset_of(
    frame: "pd.DataFrame",
    index: list[str],
    variables: Mapping[str, Variable],
    attributes: Mapping[str, Any],
) -> "xr.Dataset":
    """Return a frame as a dataset over some of its columns.

    Parameters
    ----------
    index
        Columns that become dimensions; what no row has is NaN.
    variables
        Units and meanings, by column.
    attributes
        Of the whole.
    """
    dataset = frame.set_index(index).to_xarray()
    for name, variable in variables.items():
        if name in dataset:
            dataset[name].attrs = {"long_name": variable.meaning}
            if variable.unit:
                dataset[name].attrs["units"] = variable.unit
    return dataset.assign_attrs(attributes)
