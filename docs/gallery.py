"""Draw the gallery anew: ``python -m docs.gallery``, or with names of functions to draw only those.

Every function of the program that returns a figure has to be in ``gallery.toml`` beside this file,
with the command that draws it; the commands run here, and what the functions return is kept.
"""

import ast
import os
import shlex
import shutil
import sys
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from importlib import import_module
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HERE = Path(__file__).parent
HOUSE = HERE.parent
PICTURES = HERE / "images" / "gallery"
DPI = 64
COLOURS = 64


@dataclass(frozen=True)
class Entry:
    """One plot: the function that draws it, what it shows, and the command.

    Attributes
    ----------
    why_not
        Why there is no picture, where there is none.
    """

    draws: str
    title: str
    shows: str
    command: str
    why_not: str = ""

    @property
    def picture(self) -> Path:
        """Where the picture lies."""
        return PICTURES / f"{self.draws.replace('pmm.', '', 1).replace('.', '-')}.png"


def entries() -> list[Entry]:
    """Return the list."""
    told = tomllib.loads((HERE / "gallery.toml").read_text(encoding="utf-8"))
    return [
        Entry(command=group["command"], **one)
        for group in told["commands"]
        for one in group["plots"]
    ]


def helpers() -> set[str]:
    """Return the functions that hand on another's figure."""
    told = tomllib.loads((HERE / "gallery.toml").read_text(encoding="utf-8"))
    return set(told["helpers"])


def drawing_functions() -> set[str]:
    """Return all public functions of the program that return a figure, by their full names."""
    found = set()
    for path in sorted((HOUSE / "pmm").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "from matplotlib.figure import Figure" not in text:
            continue
        module = ".".join(path.relative_to(HOUSE).with_suffix("").parts)
        for node in ast.parse(text).body:
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                returned = ast.unparse(node.returns) if node.returns else ""
                if returned.strip("'\"") == "Figure":
                    found.add(f"{module}.{node.name}")
    return found


def page() -> str:
    """Return ``gallery.md``."""
    told = tomllib.loads((HERE / "gallery.toml").read_text(encoding="utf-8"))
    lines = [told["head"]]
    shown = ""
    for one in entries():
        again = " By the command above." if one.command == shown else ""
        lines += [f"## {one.title}\n", f"{one.shows}{again}\n"]
        if not again:  # a second time it would find its folder full
            lines.append(f"```sh\n{one.command}\n```\n")
        shown = one.command
        if one.why_not:
            lines.append(f"No picture here: {one.why_not}\n")
        else:
            lines.append(f"![{one.title}]({one.picture.relative_to(HERE).as_posix()})\n")
    return "\n".join(lines)


def draw(wanted: Callable[[Entry], bool]) -> Iterator[Entry]:
    """Run the commands and keep the pictures; yield what was not drawn."""
    chosen = [one for one in entries() if wanted(one) and not one.why_not]
    PICTURES.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(HOUSE / "examples", folder / "examples")
        before = Path.cwd()
        os.chdir(folder)
        try:
            yield from _draw_all(chosen)
        finally:
            os.chdir(before)


def _draw_all(chosen: list[Entry]) -> Iterator[Entry]:
    kept: dict[str, bytes] = {}
    for command in dict.fromkeys(line for one in chosen for line in one.command.splitlines()):
        kept |= _figures_of(command)
    for one in chosen:
        if one.draws in kept:
            one.picture.write_bytes(kept[one.draws])
        else:
            yield one


def _figures_of(command: str) -> dict[str, bytes]:
    """Run a command and return the first figure of each function that drew one."""
    from click.testing import CliRunner

    from pmm.cli import cli

    with _watched([one.draws for one in entries()]) as found:
        done = CliRunner().invoke(cli, shlex.split(command)[1:])
    sys.stdout.write(f"{command}: {done.exit_code}, {len(found)} figures\n")
    if done.exit_code:
        sys.stdout.write(f"{done.stderr[-500:]}\n{done.exception!r}\n")
    return found


@contextmanager
def _watched(names: list[str]) -> Iterator[dict[str, bytes]]:
    """Keep what the named functions return, wherever they have been imported already."""
    found: dict[str, bytes] = {}
    pairs = []
    for name in names:
        module, _, function = name.rpartition(".")
        original = getattr(import_module(module), function)
        pairs.append((function, original, _watching(original, name, found)))
    for function, original, watching in pairs:
        _replace(function, original, watching)
    try:
        yield found
    finally:
        for function, original, watching in pairs:
            _replace(function, watching, original)


def _replace(function: str, old: object, new: object) -> None:
    """Put one function in another's place in every module that has it."""
    for module in list(sys.modules.values()):
        if getattr(module, "__dict__", {}).get(function) is old:
            setattr(module, function, new)


def _watching(
    original: Callable[..., Any], name: str, found: dict[str, bytes]
) -> Callable[..., Any]:
    @wraps(original)
    def drawn(*arguments: Any, **named: Any) -> Any:
        figure = original(*arguments, **named)
        if name not in found:
            found[name] = _small(figure)
        return figure

    return drawn


def _small(figure: "Figure") -> bytes:
    """Return a figure as a small PNG of few colours."""
    from PIL import Image

    from pmm.document.style import drawing

    drawn, small = BytesIO(), BytesIO()
    with drawing():
        figure.savefig(drawn, format="png", dpi=DPI)
    image = Image.open(drawn).convert("RGB").quantize(COLOURS)
    image.save(small, format="PNG", optimize=True)
    return small.getvalue()


def main() -> None:
    """Draw what is named, or all, and write the page."""
    names = sys.argv[1:]
    missing = list(draw(lambda one: not names or any(name in one.draws for name in names)))
    (HERE / "gallery.md").write_text(page(), encoding="utf-8")
    if missing:
        sys.exit("not drawn: " + ", ".join(one.draws for one in missing))


if __name__ == "__main__":
    main()
