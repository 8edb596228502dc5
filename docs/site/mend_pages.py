#!/usr/bin/python3
"""Mends what Debian's furo leaves in the pages: it asks for files outside of them, and screen readers stumble.

usage: mend_pages.py FOLDER
"""

import re
import shutil
import sys
from pathlib import Path

MENDED = (
    (r'<p class="caption" role="heading">', '<p class="caption" role="heading" aria-level="2">'),
    (r'<label class="overlay ', '<label aria-hidden="true" class="overlay '),
    (r'<label class="toc-overlay-icon toc-content-icon', '<label aria-hidden="true" class="toc-overlay-icon toc-content-icon'),
    (r'<aside class="sidebar-drawer">', '<aside class="sidebar-drawer" aria-label="Pages">'),
    (r'<aside class="toc-drawer', '<aside aria-label="On this page" class="toc-drawer'),
    # its dark colours are there for code alone
    (r"document\.body\.dataset\.theme = [^;]*;", 'document.body.dataset.theme = "light";'),
    (r"<pre>", '<pre tabindex="0">'),
    (r'<div class="table-wrapper', '<div tabindex="0" class="table-wrapper'),
    (r'<th class="head[^"]*">(<p></p>)?</th>', "<td></td>"),
    # a module, which no browser loads from a file: it switches colours, and all else works without
    (r'<script src="[^"]*_static/scripts/furo.js"></script>', ""),
)


def main():
    folder = Path(sys.argv[1])
    for path in folder.rglob("*.html"):
        text = path.read_text()
        for pattern, mended in MENDED:
            text = re.sub(pattern, mended, text)
        if path.name == "search.html":
            text = text.replace('<div id="search-results">', '<h1>Search</h1><div id="search-results">')
        path.write_text(text)
    style = folder / "_static/styles/furo.css"
    style.write_text(style.read_text().replace("/javascript/normalize.css/normalize.css", "normalize.css"))
    shutil.copy("/usr/share/javascript/normalize.css/normalize.css", style.parent)


if __name__ == "__main__":
    main()
