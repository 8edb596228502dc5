#!/usr/bin/python3
"""Names every part of the public C++ interface without a word of documentation.

usage: undocumented.py XML_FOLDER      of Doxygen
Exit status 1 where there is one. What the language makes (defaulted, deleted, destructors) needs none,
nor does an enumerator: its name and the sentence of its enumeration say it.
"""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path


def documented(element):
    texts = [element.find(kind) for kind in ("briefdescription", "detaileddescription")]
    return any(text is not None and "".join(text.itertext()).strip() for text in texts)


def made_by_the_language(member):
    arguments = member.findtext("argsstring") or ""
    return arguments.rstrip().endswith(("=default", "=delete", "= default", "= delete")) or member.findtext("name", "").startswith("~")


def parts(folder):
    """(place, name, documented) of every public compound and member."""
    seen = set()
    for path in sorted(Path(folder).glob("*.xml")):
        for compound in ET.parse(path).iter("compounddef"):
            if compound.get("kind") in ("class", "struct", "union") and compound.get("prot") == "public":
                yield place(compound), compound.findtext("compoundname"), documented(compound)
            elif compound.get("kind") not in ("namespace", "file"):
                continue
            for member in compound.iter("memberdef"):
                if member.get("prot") != "public" or member.get("id") in seen or member.get("kind") in ("friend", "define"):
                    continue
                seen.add(member.get("id"))
                if made_by_the_language(member):
                    continue
                name = f"{compound.findtext('compoundname')}::{member.findtext('name')}"
                yield place(member), name, documented(member)


def place(element):
    location = element.find("location")
    return f"{location.get('file')}:{location.get('line')}" if location is not None else "?"


def main():
    found = list(parts(sys.argv[1]))
    if not found:
        sys.exit(f"undocumented.py: no public interface in {sys.argv[1]}")
    missing = [(where, name) for where, name, said in found if not said]
    for where, name in missing:
        print(f"{where}: {name}: not documented")
    print(f"{len(found) - len(missing)} of {len(found)} public names are documented")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
