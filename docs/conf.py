"""How the pages become a site: ``make docs``, or ``python -m sphinx -W docs site``."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from docutils.nodes import math, math_block
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

HOUSE = Path(__file__).parents[1]
sys.path.insert(0, str(HOUSE))

project = "PMM"
author = "the PMM authors"
extensions = [
    "myst_nb",
    "sphinx.ext.apidoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
source_suffix = {".md": "myst-nb", ".rst": "restructuredtext"}
root_doc = "index"
exclude_patterns = ["api/*/modules.rst"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_links_external_new_tab = False

nb_execution_timeout = 300  # seconds a cell: they take a few, on a machine that does nothing else
nb_execution_raise_on_error = True

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


html_math_renderer = "mathml"


def write_math(page: "HTML5Translator", node: "math | math_block") -> None:
    """Write an equation as MathML, which a browser draws without asking anybody for a script."""
    from docutils.nodes import SkipNode, math_block
    from docutils.utils.math.latex2mathml import tex2mathml

    alone = isinstance(node, math_block)
    equation = tex2mathml(node.astext(), as_block=alone)
    # What stands above and below an equation would else make its frame scroll.
    page.body.append(f'<div style="padding: 0.3em 0">{equation}</div>' if alone else equation)
    raise SkipNode


def setup(app: "Sphinx") -> None:
    """Make known what our pages call their excerpts, and how an equation is drawn."""
    from pygments.lexers.special import TextLexer

    app.add_html_math_renderer("mathml", (write_math, None), (write_math, None))

    for name in ("csv", "options"):
        app.add_lexer(name, TextLexer)
