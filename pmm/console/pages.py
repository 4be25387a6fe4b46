"""Pages and figures in campaigns' folders (report, gap, inertia), shown apart from the console."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from anyio.to_thread import run_sync
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response

# Their own scripts and styles may run, in an origin of their own: they cannot reach the console.
_POLICY: Final = (
    "sandbox allow-scripts allow-popups; default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; img-src data:; font-src data:"
)
_KINDS: Final = (".html", ".svg")


class Pages:
    """Lists and serves pages: those of the folders, and of the folders directly in them.

    Parameters
    ----------
    campaigns
        Returns the folders of the campaigns at hand.
    beside
        One more folder: where campaigns are recorded.
    """

    def __init__(self, campaigns: Callable[[], list[Path]], beside: Path) -> None:
        self._campaigns, self._beside = campaigns, beside
        self._numbers: dict[Path, int] = {}

    def folders(self) -> tuple[Path, ...]:
        """Return where to look for pages: there, and in the folders directly in them."""
        return (self._beside, *self._campaigns())

    def listed(self, pages: Mapping[Path, Sequence[str]]) -> list[dict[str, Any]]:
        """Return the pages of the folders with their addresses.

        Each folder keeps its number, so that an address stays good.
        """
        for folder in pages:
            self._numbers.setdefault(folder, len(self._numbers))
        return [
            {"name": name, "folder": folder.name, "address": f"/pages/{number}/{name}"}
            for folder, number in self._numbers.items()
            for name in pages.get(folder, ())
        ]

    async def page(self, request: Request) -> Response:
        """Serve a page in one of the folders that were listed; no other file."""
        number, name = request.path_params["folder"], request.path_params["name"]
        folder = next((path for path, n in self._numbers.items() if n == number), None)
        page = None if folder is None else await run_sync(_page, folder, name)
        if page is None:
            return PlainTextResponse("no such page", 404)
        return FileResponse(page, headers={"content-security-policy": _POLICY})


def pages_in(folders: Iterable[Path]) -> dict[Path, list[str]]:
    """Return the names of the pages in folders and in the folders directly in them."""
    places = dict.fromkeys(place for folder in folders for place in (folder, *_subfolders(folder)))
    return {folder: [page.name for page in _pages(folder)] for folder in places}


def _page(folder: Path, name: str) -> Path | None:
    return next((page for page in _pages(folder) if page.name == name), None)


def _subfolders(folder: Path) -> list[Path]:
    return [
        entry for entry in _entries(folder) if entry.is_dir() and not entry.name.startswith(".")
    ]


def _pages(folder: Path) -> list[Path]:
    return [entry for entry in _entries(folder) if entry.suffix in _KINDS and entry.is_file()]


def _entries(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []
