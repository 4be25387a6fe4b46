"""Pages and figures in campaigns' folders (report, gap, inertia), shown apart from the console."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

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

    def listed(self) -> list[dict[str, Any]]:
        """Return the pages there are, with their addresses."""
        return [
            {"name": path.name, "folder": folder.name, "address": f"/pages/{number}/{path.name}"}
            for folder, number in self._folders().items()
            for path in _pages(folder)
        ]

    async def page(self, request: Request) -> Response:
        """Serve one of the pages that are listed; no other file."""
        number, name = request.path_params["folder"], request.path_params["name"]
        folder = next((one for one, n in self._folders().items() if n == number), None)
        found = [] if folder is None else _pages(folder)
        path = next((one for one in found if one.name == name), None)
        if path is None:
            return PlainTextResponse("no such page", 404)
        return FileResponse(path, headers={"content-security-policy": _POLICY})

    def _folders(self) -> dict[Path, int]:
        """Return the folders; each keeps its number, so that an address stays good."""
        for one in (self._beside, *self._campaigns()):
            for folder in (one, *_within(one)):
                self._numbers.setdefault(folder, len(self._numbers))
        return self._numbers


def _within(folder: Path) -> list[Path]:
    return [one for one in _entries(folder) if one.is_dir() and not one.name.startswith(".")]


def _pages(folder: Path) -> list[Path]:
    return [one for one in _entries(folder) if one.suffix in _KINDS and one.is_file()]


def _entries(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []
