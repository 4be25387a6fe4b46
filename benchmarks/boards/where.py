"""Where in the product an error arose, in a line."""

import traceback
from pathlib import Path
from typing import Final

_FRAMES: Final = 3  # innermost ones of the product that are named
_LETTERS: Final = 160


def arose(error: BaseException) -> str:
    """Return an error's class, what it says, and the product's innermost functions."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [one for one in frames if "site-packages" not in one.filename] or list(frames)
    named = [f"{Path(one.filename).name}:{one.name}" for one in own[: -_FRAMES - 1 : -1]]
    return f"{type(error).__name__}: {str(error)[:_LETTERS]} at {' < '.join(named)}"
