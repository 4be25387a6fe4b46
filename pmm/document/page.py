"""A document as one HTML page: it needs no other file, no network and no script.

It reads in light and dark, on a phone and in print.
"""

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

from pmm.document.content import Content, Document, Figure, Section
from pmm.document.style import render
from pmm.version import provenance
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from jinja2 import Environment

_WITHOUT = ("metadata", "style")
_REFERENCE = re.compile(r"url\(#([^)]*)\)")


def inline_svg(svg: bytes, prefix: str, description: str) -> str:
    """Return a drawing as an element to put into HTML.

    It is an ``svg`` element without namespaces (HTML implies them), XML header, metadata and style
    sheet; the latter would apply to the whole page.

    Parameters
    ----------
    svg
        A file that :func:`pmm.document.style.render` made.
    prefix
        Goes before every id and every reference to one.
    description
        What a screen reader says in place of the drawing.
    """
    root = ET.fromstring(svg)  # noqa: S314  our own drawing, not a stranger's
    for element in root.iter():
        for child in [child for child in element if _local(str(child.tag)) in _WITHOUT]:
            element.remove(child)
        element.tag = _local(str(element.tag))
        element.attrib = {
            _local(name): _prefixed(_local(name), value, prefix)
            for name, value in element.attrib.items()
        }
    root.attrib |= {
        "role": "img",
        "aria-label": description,
        # What the drawing's own style sheet said of all its parts.
        "style": "stroke-linejoin: round; stroke-linecap: butt",
    }
    # The page sets the width; the height follows from the view box.
    for name in ("width", "height", "version"):
        root.attrib.pop(name, None)
    return ET.tostring(root, encoding="unicode")


def _local(name: str) -> str:
    """Drop the namespace."""
    return name.rpartition("}")[2]


def _prefixed(name: str, value: str, prefix: str) -> str:
    if name == "id":
        return f"{prefix}-{value}"
    if name == "href" and value.startswith("#"):
        return f"#{prefix}-{value.removeprefix('#')}"
    return _REFERENCE.sub(lambda match: f"url(#{prefix}-{match[1]})", value)


@dataclass(frozen=True)
class _Part:
    """A content, by its kind as the template knows it; figures as markup."""

    kind: str
    content: Content
    svg: str = ""


@dataclass(frozen=True)
class _File:
    name: str
    sha256: str
    text: str


def write_page(
    document: Document, path: Path, *, command: str, title: str = "", read: Sequence[Path] = ()
) -> None:
    """Write a document as a page.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it, so that it can be made again.
    title
        Heading in place of the document's own.
    read
        Configuration to show in full, with hashes.
    """
    content = {
        "title": title or f"{document.name}: {document.about}",
        "sections": _sections(document),
        "command": command,
        "versions": provenance(),
        "files": [_file(source) for source in read],
    }
    write_template("page.html.jinja", content, path)


def write_template(
    name: str, content: Mapping[str, Any], path: Path, package: str = "pmm.document"
) -> None:
    """Fill a package's template and write it as a page; all pages share one style.

    Parameters
    ----------
    content
        Plain text by the template's names: all of it is escaped. The drawings alone are markup, and
        their text was escaped in them.
    """
    template = _templates().from_string(_text(name, package))
    page = template.render(style=_text("page.css"), **content)
    path.parent.mkdir(parents=True, exist_ok=True)
    # A file name may hold bytes that are no text; they must not cost the page.
    write_whole(path, page.encode("utf-8", errors="replace"))


def tables_as_html(document: Document) -> str:
    """Return a document's texts, notes and tables as HTML without a style, for a notebook."""
    sections = [
        replace(
            section,
            contents=tuple(part for part in section.contents if not isinstance(part, Figure)),
        )
        for section in document.sections
    ]
    content = _sections(replace(document, sections=tuple(sections)))
    return _templates().get_template("sections.html.jinja").render(sections=content)


def _templates() -> "Environment":
    """Return what fills templates; those of this package may be included by name."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FunctionLoader(_text),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["markup"] = Markup
    return environment


def _text(name: str, package: str = "pmm.document") -> str:
    return files(package).joinpath(name).read_text(encoding="utf-8")


def _sections(document: Document) -> list[tuple[Section, str, list[_Part]]]:
    return [
        (section, _anchor(section, place), parts)
        for place, section in enumerate(document.sections)
        if (parts := _parts(section))
    ]


def _anchor(section: Section, place: int) -> str:
    """Return what links name a section by: titles may be the same, or have no letters."""
    return f"{re.sub(r'[^a-z0-9]+', '-', section.title.lower()).strip('-')}-{place}"


def _parts(section: Section) -> list[_Part]:
    return [
        _Part(
            type(content).__name__, content, drawn(content) if isinstance(content, Figure) else ""
        )
        for content in section.contents
        if not content.empty
    ]


def drawn(figure: Figure) -> str:
    """Return a figure as markup; its name tells its ids from those of the page's others."""
    return inline_svg(render(figure.draw(), "svg", figure.name), figure.name, figure.caption)


def _file(path: Path) -> _File:
    data = path.read_bytes()
    return _File(path.name, hashlib.sha256(data).hexdigest(), data.decode(errors="replace"))
