"""Sphinx on the tree that site.py lays out: the project's documents where they stand, beside what is generated."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

project = "zwidth"
author = "the zwidth authors"
project_copyright = author
release = version = os.environ["ZWIDTH_VERSION"]
root_doc = "docs/index"
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "equations"]
html_math_renderer = "katex"
myst_enable_extensions = ["dollarmath"]
myst_dmath_allow_labels = False
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_heading_anchors = 4
breathe_projects = {"zwidth": os.environ["ZWIDTH_DOXYGEN_XML"]}
breathe_default_project = "zwidth"
autodoc_member_order = "groupwise"
autodoc_typehints = "description"
html_theme = "furo"
html_title = f"zwidth {release}"
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
pygments_style = "bw"
copybutton_selector = "div:not(.highlight-text) > div.highlight pre"  # what programs print is not for a command line
copybutton_prompt_text = "$ "  # of a console block its commands alone
copybutton_line_continuation_character = "\\"


def escape_signatures(app, what, name, obj, options, lines):
    """pybind11 writes the signatures of overloads into docstrings, as plain text: (*args, **kwargs)."""
    lines[:] = [line.replace("**", r"\*\*").replace("*args", r"\*args").replace("|", r"\|") for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", escape_signatures)
