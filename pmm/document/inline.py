"""SVG drawings as part of a page: no header, no ids that meet another drawing's."""

import re
from xml.etree import ElementTree as ET

_WITHOUT = ("metadata", "style")
_REFERENCE = re.compile(r"url\(#([^)]*)\)")


def inline_svg(svg: bytes, prefix: str, description: str) -> str:
    """Return a drawing as an element to put into HTML.

    Parameters
    ----------
    svg
        A file that :func:`pmm.document.style.render` made.
    prefix
        Goes before every id and every reference to one.
    description
        What a screen reader says in place of the drawing.

    Returns
    -------
    str
        An ``svg`` element without namespaces (HTML implies them), XML header, metadata and style
        sheet; the latter would apply to the whole page.
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
    return _REFERENCE.sub(lambda found: f"url(#{prefix}-{found[1]})", value)
