#!/usr/bin/python3
"""docs/identification_tests.md names every kind of record of the identification campaign, once, and no other.

usage: campaign_kinds.py ROOT
"""

import re
import sys
from pathlib import Path


def main():
    root = Path(sys.argv[1])
    kinds = re.findall(r'Kind\{"(\w+)"', (root / "tests/identification/campaign/kinds.hpp").read_text(encoding="utf-8"))
    page = (root / "docs/identification_tests.md").read_text(encoding="utf-8")
    rows = page.split("\n## Kinds\n")[1].split("\n## ")[0]
    named = [kind for row in re.findall(r"^\| [^|]* \| (.*) \|$", rows, re.M) for kind in re.findall(r"`(\w+)`", row)]
    if not kinds or sorted(kinds) != sorted(named):
        raise SystemExit(f"docs/identification_tests.md lacks {set(kinds) - set(named)}, and names besides {set(named) - set(kinds)}")


if __name__ == "__main__":
    main()
