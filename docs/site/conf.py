"""Of the site that scripts/docs builds out of the pages which generate.py has put together."""

from pathlib import Path

built = Path(__file__).resolve().parents[2] / "build/docs"

project = "zwidth"
copyright = "the zwidth maintainers"
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
html_theme = "furo"
html_title = "zwidth"
html_copy_source = False
html_show_sourcelink = False
html_static_path = [str(built / "static")]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
breathe_projects = {"zwidth": str(built / "xml")}
breathe_default_project = "zwidth"
breathe_default_members = ("members",)
primary_domain = "cpp"
highlight_language = "none"
autodoc_typehints = "description"
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"  # Debian's, beside the pages: they need no server


def as_plain_text(app, what, name, obj, options, lines):
    """The module's docstrings are plain text: |z| and **options are no markup."""
    lines[:] = [line.replace("|", r"\|").replace("**", r"\*\*") for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", as_plain_text)
