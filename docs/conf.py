"""How the pages become a site: ``make docs``, or ``python -m sphinx -W docs site``."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

HOUSE = Path(__file__).parents[1]
sys.path.insert(0, str(HOUSE))

project = "PMM"
author = "the PMM authors"
extensions = [
    "myst_parser",
    "sphinx.ext.apidoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
exclude_patterns = ["api/*/modules.rst"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_links_external_new_tab = False

apidoc_modules = [
    {
        "path": str(HOUSE / room),
        "destination": f"api/{room}",
        "separate_modules": False,
        "max_depth": 2,
        "module_first": True,
        "automodule_options": {"members"},
        "exclude_patterns": [str(HOUSE / "pmm" / "cli")],
    }
    for room in ("hardware", "sim", "analysis", "pmm")
]
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_google_docstring = False
napoleon_use_ivar = True

# A field's name stands in many classes; within a docstring its own class is meant.
suppress_warnings = ["ref.python"]
html_theme = "furo"
html_title = "PMM"
html_show_sphinx = False
html_copy_source = False


def setup(app: "Sphinx") -> None:
    """Make known what our pages call their excerpts."""
    from pygments.lexers.special import TextLexer

    for name in ("csv", "options"):
        app.add_lexer(name, TextLexer)
