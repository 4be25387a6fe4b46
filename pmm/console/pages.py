"""Pages that campaigns' folders hold (report, gap, inertia), shown apart from the console."""

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


class Pages:
    """Lists and serves the pages.

    Parameters
    ----------
    campaigns
        Returns the folders of the campaigns at hand.
    beside
        One more folder: where campaigns are recorded.
    """

    def __init__(self, campaigns: Callable[[], list[Path]], beside: Path) -> None:
        self._campaigns, self._beside = campaigns, beside

    def listed(self) -> list[dict[str, Any]]:
        """Return the pages there are, with their addresses."""
        return [
            {"name": path.name, "folder": folder.name, "address": f"/pages/{number}/{path.name}"}
            for number, folder in enumerate(self._folders())
            for path in _pages(folder)
        ]

    async def page(self, request: Request) -> Response:
        """Serve one of the pages that are listed; no other file."""
        number, name = request.path_params["folder"], request.path_params["name"]
        folders = self._folders()
        found = _pages(folders[number]) if number < len(folders) else []
        path = next((one for one in found if one.name == name), None)
        if path is None:
            return PlainTextResponse("no such page", 404)
        return FileResponse(path, headers={"content-security-policy": _POLICY})

    def _folders(self) -> list[Path]:
        return list(dict.fromkeys((self._beside, *self._campaigns())))


def _pages(folder: Path) -> list[Path]:
    try:
        return sorted(one for one in folder.glob("*.html") if one.is_file())
    except OSError:
        return []
