#!/usr/bin/python3
"""docs/identification_tests.md names every kind of record of the campaign, docs/identification_method.md every rival, and no other.

usage: identification_pages.py ROOT
"""

import re
import sys
from pathlib import Path


def text(root, name):
    return (root / name).read_text(encoding="utf-8")


def section(page, title):
    return page.split(f"\n## {title}\n")[1].split("\n## ")[0]


def compare(page, named, declared):
    if not declared or sorted(named) != sorted(declared):
        lacking, besides = sorted(set(declared) - set(named)), sorted(set(named) - set(declared))
        raise SystemExit(f"{page} lacks {lacking}, and names besides, or twice: {besides}")


def main():
    root = Path(sys.argv[1])
    page = "docs/identification_tests.md"
    rows = re.findall(r"^\| [^|]* \| (.*) \|$", section(text(root, page), "Kinds"), re.M)
    kinds = re.findall(r'Kind\{"(\w+)"', text(root, "tests/identification/campaign/kinds.hpp"))
    compare(page, re.findall(r"`(\w+)`", " ".join(rows)), kinds)

    page = "docs/identification_method.md"
    named = re.findall(r"^\| `(\w+)` \|", section(text(root, page), "Rivals"), re.M)
    files = sorted((root / "src/identification/model/rivals").glob("*.cpp"))
    rivals = [code for file in files for code in re.findall(r'^Rival \w+\(\) \{ return \{"(\w+)"', file.read_text(encoding="utf-8"), re.M)]
    compare(page, named, rivals)


if __name__ == "__main__":
    main()
