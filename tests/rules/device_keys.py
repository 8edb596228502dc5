#!/usr/bin/python3
"""docs/device_file.md's table and web/src/model/device_keys.json: the keys of the device file, as the program prints them.

usage: device_keys.py PROGRAM ROOT [--write]
Compares the two with `PROGRAM --generate keys`, which is the table of src/model/device_keys.cpp, or writes them.
"""

import json
import subprocess
import sys
from pathlib import Path

HEAD = "| key | unit | default | allowed | what it is |\n|---|---|---|---|---|\n"
FIRST = "1.0"  # version


def table(keys):
    text = HEAD
    for each in keys["tables"]:
        if each["path"]:
            text += f"| **`{each['header']}`**{since(each)} | | {each['default']} | {each['allowed']} | |\n"
        for key in each["keys"]:
            unit = key["unit"]["linear"] if key["unit"] else ""
            text += f"| `{key['key']}`{since(key)} | {unit} | {key['default']} | {key['allowed']} | {key['help']} |\n"
    return text.replace("|  |", "| |").replace("|  |", "| |")


def since(key):
    return "" if key["since"] == FIRST else f", since {key['since']}"


def document(file, keys):
    before, _, rest = file.read_text(encoding="utf-8").partition("| key | unit |")
    return before + table(keys) + rest[rest.index("\n\n") + 1 :]


def of_page(keys):
    """What the page needs, a line a key."""
    names = ("key", "type", "unit", "takes_zero", "default", "help", "same_as")
    lines = [
        json.dumps({"table": each["path"], **{name: key[name] for name in names}}, ensure_ascii=False)
        for each in keys["tables"]
        for key in each["keys"]
    ]
    return "[\n" + ",\n".join(lines) + "\n]\n"


def main():
    program, root = sys.argv[1], Path(sys.argv[2])
    printed = subprocess.run([program, "--generate", "keys"], check=True, capture_output=True, encoding="utf-8").stdout
    keys = json.loads(printed)
    page, docs = root / "web/src/model/device_keys.json", root / "docs/device_file.md"
    for file, text in [(page, of_page(keys)), (docs, document(docs, keys))]:
        if sys.argv[3:] == ["--write"]:
            file.write_text(text, encoding="utf-8")
        elif not file.exists() or file.read_text(encoding="utf-8") != text:
            raise SystemExit(f"{file.name} is not what the program says: tests/rules/device_keys.py PROGRAM . --write")


if __name__ == "__main__":
    main()
