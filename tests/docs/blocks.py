"""The code blocks of the README and of all pages."""

import re
from dataclasses import dataclass
from pathlib import Path

HOUSE = Path(__file__).parents[2]
_BLOCK = re.compile(
    r"(?:^<!-- not run: (?P<reason>[^\n]+?) -->\n)?^```(?P<language>[\w{}-]*)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


@dataclass(frozen=True)
class Block:
    """One block of a page.

    Attributes
    ----------
    reason
        Why it is not run, from the comment before it; empty if it is.
    number
        Counted from 1 within its page.
    """

    page: str
    number: int
    language: str
    text: str
    reason: str

    def __str__(self) -> str:
        return f"{self.page}-{self.number}"


def pages() -> list[Path]:
    """Return the README and all pages, without those that the site makes of the code."""
    docs = HOUSE / "docs"
    found = [*docs.glob("*.md"), *(docs / "decisions").glob("*.md"), docs / "api" / "index.md"]
    return [HOUSE / "README.md", *sorted(found)]


def blocks(*languages: str) -> list[Block]:
    """Return the blocks of some languages, all pages together."""
    return [
        Block(path.relative_to(HOUSE).as_posix(), number, match["language"], match["text"],
              match["reason"] or "")
        for path in pages()
        for number, match in enumerate(_BLOCK.finditer(path.read_text(encoding="utf-8")), 1)
        if not languages or match["language"] in languages
    ]  # fmt: skip
