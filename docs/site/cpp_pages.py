"""The C++ reference: a page per room of include/zwidth, its headers in turn, from Doxygen's XML."""

import os
import xml.etree.ElementTree as ET
from collections import Counter, defaultdict
from pathlib import Path

DIRECTIVES = {"function": "doxygenfunction", "enum": "doxygenenum", "typedef": "doxygentypedef", "variable": "doxygenvariable"}


def signature(member, count):
    """The name, and where it has overloads the types of its parameters."""
    name = f"zwidth::{member.findtext('name')}"
    if count[member.findtext("name")] == 1:
        return name
    return name + "(" + ", ".join("".join(each.find("type").itertext()) for each in member.findall("param")) + ")"


def directives(xml):
    """The directives of each header, in the order of its lines."""
    found = defaultdict(list)
    for path in sorted(xml.glob("*.xml")):
        for compound in ET.parse(path).iter("compounddef"):
            name = compound.findtext("compoundname")
            if compound.get("kind") in ("class", "struct") and name.count("::") == 1 and compound.get("prot") == "public":
                place = compound.find("location")
                options = ["   :members:", "   :undoc-members:"]
                found[place.get("file")].append((int(place.get("line")), [f".. doxygen{compound.get('kind')}:: {name}", *options]))
            elif compound.get("kind") == "namespace" and name == "zwidth":
                members = [each for each in compound.iter("memberdef") if each.get("kind") in DIRECTIVES]
                count = Counter(each.findtext("name") for each in members)
                for each in members:
                    place = each.find("location")
                    header = place.get("declfile") or place.get("file")
                    line = place.get("declline") or place.get("line")
                    found[header].append((int(line), [f".. {DIRECTIVES[each.get('kind')]}:: {signature(each, count)}"]))
    return found


def write(root, tree):
    folder = tree / "docs/reference/cpp"
    folder.mkdir(parents=True)
    include = root / "include"
    rooms = [include / "zwidth", *sorted(path for path in (include / "zwidth").iterdir() if path.is_dir())]
    found = directives(Path(os.environ["ZWIDTH_DOXYGEN_XML"]))
    for room in rooms:
        title = str(room.relative_to(include))
        lines = [title, "=" * len(title), ""]
        for header in sorted(room.glob("*.hpp")):
            parts = sorted(found.pop(f"{title}/{header.name}", []))
            if parts:
                lines += [header.name, "-" * len(header.name), ""]
            for _, part in parts:
                lines += [*part, ""]
        (folder / f"{room.name}.rst").write_text("\n".join(lines))
    if found:
        raise SystemExit(f"cpp_pages.py: in no room: {', '.join(found)}")
    listed = "\n".join(room.name for room in rooms)
    (folder / "index.md").write_text(
        "# C++\n\n`#include <zwidth/zwidth.hpp>`, one folder of headers per room ([architecture](../../architecture.md)). "
        f"SI units and radians.\n\n```{{toctree}}\n{listed}\n```\n"
    )
