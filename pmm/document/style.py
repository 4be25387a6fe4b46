"""How every figure looks: colours, fonts, and settings that never leave this module."""

import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hardware.description.errors import ConfigurationError
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from pmm.document.content import Figure as DocumentFigure

# Okabe and Ito's colours, told apart with any colour vision; their yellow is lost on white.
PALETTE: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
TRACE: Final = "#555555"
FIT: Final = "#D55E00"
RECORD_SHADE: Final = "#F2F2F2"
STEADY_SHADE: Final = "#D3E6F3"
GATE_SHADE: Final = "#FBE0B5"

_NO_DATES: Final[dict[str, dict[str, str | None]]] = {
    "svg": {"Date": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None},
}

_CANVASES: Final = {
    "svg": ("backend_svg", "FigureCanvasSVG"),
    "png": ("backend_agg", "FigureCanvasAgg"),
    "pdf": ("backend_pdf", "FigureCanvasPdf"),
}

_SETTINGS: Final[Any] = {
    "font.family": ["sans-serif"],
    # What is measured with; a reader without it sees another sans-serif, none of them wider.
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#D9D9D9",
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "figure.titlesize": 11.0,
    "figure.facecolor": "white",
    "lines.linewidth": 1.0,
    "savefig.dpi": 150.0,
    "svg.fonttype": "none",
    # Names come from users: a dollar sign in one is a dollar sign.
    "text.parse_math": False,
}


@contextmanager
def drawing() -> Iterator[None]:
    """Draw with this project's settings, whatever the user's own are, and put those back after."""
    import matplotlib as mpl

    with mpl.rc_context(), warnings.catch_warnings():
        # A name in a script that the font lacks still reads well where the reader's font has it.
        warnings.filterwarnings("ignore", message=r"Glyph .* missing from font")
        mpl.rcdefaults()
        mpl.rcParams.update(_SETTINGS)
        yield


@contextmanager
def new_figure(width_in: float, height_in: float, title: str = "") -> "Iterator[Figure]":
    """Give an empty figure of that size in inches to draw on, with this project's settings."""
    from matplotlib.figure import Figure

    with drawing():
        figure = Figure(figsize=(width_in, height_in), layout="constrained")
        if title:
            figure.suptitle(title)
        yield figure


def label_decades(axis: "Axis") -> None:
    """Label a logarithmic axis with plain numbers: each decade, and 2 and 5 within it."""
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter(lambda value, _: f"{value:g}" if f"{value:.0e}"[0] in "25" else "")


def render(figure: "Figure", kind: str, salt: str) -> bytes:
    """Return a figure as a file's bytes, the same each time.

    Parameters
    ----------
    kind
        ``"svg"``, ``"png"`` or ``"pdf"``.
    salt
        Goes into the ids of an SVG in place of chance.

    Raises
    ------
    ConfigurationError
        If the format is not one of these.
    """
    import matplotlib as mpl

    if kind not in _CANVASES:
        raise ConfigurationError(
            f"figures are not written as {kind!r}; choose from {', '.join(_CANVASES)}"
        )
    module, canvas = _CANVASES[kind]
    buffer = BytesIO()
    with drawing():
        mpl.rcParams["svg.hashsalt"] = salt
        figure.dpi = mpl.rcParams["savefig.dpi"]
        _lay_out(figure)
        on = getattr(import_module(f"matplotlib.backends.{module}"), canvas)(figure)
        getattr(on, f"print_{kind}")(buffer, metadata=_NO_DATES[kind])
    return compact(buffer.getvalue()) if kind == "svg" else buffer.getvalue()


def _lay_out(figure: "Figure") -> None:
    """Give the axes their places, once: later files of the figure find no more to be done.

    ``savefig`` would lay out and draw anew for each file, and draw once more before it writes,
    which is half of all the time that figures take.
    """
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")


def write_figure(
    figure: "Figure", folder: Path, name: str, formats: Sequence[str] = ("svg", "png")
) -> list[Path]:
    """Write a figure as ``<name>.<format>`` and return the files; the folder is made.

    It raises what :func:`render` raises.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.{suffix}" for suffix in formats]
    for path, suffix in zip(paths, formats, strict=True):
        write_whole(path, render(figure, suffix, name))
    return paths


def write_figures(
    figures: Iterable["DocumentFigure"],
    folder: Path,
    stem: str,
    formats: Sequence[str] = ("svg", "png"),
) -> list[Path]:
    """Write figures of a document as ``<stem>-<name>.<format>`` and return the files.

    Raises
    ------
    ConfigurationError
        If a format is not known or the stem is no plain file name.
    """
    if not stem or Path(stem).name != stem:
        raise ConfigurationError(f"figures cannot be named {stem!r}; give a name without a folder")
    return [
        path
        for figure in figures
        for path in write_figure(figure.draw(), folder, f"{stem}-{figure.name}", formats)
    ]


def compact(svg: bytes) -> bytes:
    """Return an SVG with its coordinates in hundredths of a point and without indentation."""
    text = re.sub(r"\s*\n\s*", "\n", svg.decode())
    text = re.sub(r"\n([LCQ]) (?=[-\d])", r"\1", text)
    return re.sub(r"<(?:path|use|text) [^>]*>", _round, text).encode()


def _round(tag: re.Match[str]) -> str:
    return re.sub(
        r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), tag[0]
    )
