#!/usr/bin/python3
"""Holds the sources to the rules of CONTRIBUTING.md.

usage: check_rules.py ROOT RULE      RULE: flow, words, sizes, names, disk or headers
Prints every line that breaks the rule, and exits with 1 where there is one.
"""

import re
import sys
from pathlib import Path

# Room: the rooms that its files may include, besides itself and the public headers that stand in no room.
LIBRARY = {
    "words": [],
    "model": [],
    "signal": [],
    "sampling": ["model"],
    "control": ["model", "sampling"],
    "batch/kernel": ["model", "sampling"],
    "stability": ["model", "sampling", "batch/kernel"],
    "io": ["model", "signal", "study"],
    "simulation": ["words", "model", "signal", "sampling", "control", "stability"],
    "identification": ["words", "model", "signal", "sampling", "stability", "simulation"],
    "batch": ["model", "sampling", "stability", "batch/kernel"],
    "design": ["model", "signal", "sampling", "stability", "batch"],
    "study": ["model", "sampling", "stability", "batch", "design"],
    "rig": ["words", "model", "signal", "sampling", "control", "stability", "simulation", "identification"],
}
APPS = {
    "results": [],
    "report": ["results"],
    "export": ["results", "report"],
    "reproduce": ["results", "report"],
    "server": ["results"],
    "study": ["results", "report"],
    "rig": ["results"],
    "cli": ["results", "report", "export", "reproduce", "server", "study", "rig"],
    "on_demand": ["study"],
}
MOST_LINES = 500
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
STRING = re.compile(r'"(?:[^"\\]|\\.)*"')


def files(root, *folders):
    for folder in folders:
        yield from sorted(path for path in (root / folder).rglob("*") if path.suffix in (".cpp", ".hpp"))


def lines(path):
    return enumerate(path.read_text(encoding="utf-8").splitlines(), 1)


def includes(path):
    for number, line in lines(path):
        if match := INCLUDE.match(line):
            yield number, match[1]


def room_of_library(path):
    """"zwidth/model/device.hpp" and "model/balance.hpp" -> "model"; a folder of a room may be one; nothing for a header in none."""
    folder = path.removeprefix("zwidth/").rpartition("/")[0]
    return folder if folder in LIBRARY else folder.split("/")[0] or None


def flow(root):
    """Includes go where the flow of the house goes; the program and its reports see public headers alone."""
    for base in ("include/zwidth", "src"):
        for path in files(root, base):
            own = room_of_library(str(path.relative_to(root / base)))
            for number, included in includes(path):
                room = room_of_library(included)
                if own is None and base == "include/zwidth":
                    continue  # zwidth.hpp
                if room is not None and room != own and room not in LIBRARY.get(own, ["words"]):
                    yield path, number, f"{own} may not include {included}"
                if base == "include/zwidth" and not included.startswith("zwidth/"):
                    yield path, number, f"a public header includes the private {included}"
    for path in files(root, "bindings"):
        for number, included in includes(path):
            beside = (path.parent / included).exists()
            if not beside and included.split("/")[0] not in ("zwidth", "results", "server", "cli"):
                yield path, number, f"bindings may not include {included}"
    for path in files(root, "apps"):
        own = path.relative_to(root / "apps").parts[0]
        for number, included in includes(path):
            first = included.split("/")[0]
            if own == "on_demand" and (root / "src" / included).exists():
                continue  # functions of the library, which its stand-ins take the place of
            if first == "zwidth":
                if not (root / "include" / included).exists():
                    yield path, number, f"{included} is no public header"
            elif first not in APPS:
                yield path, number, f"{included} is neither public nor a part of apps/"
            elif first != own and first not in APPS.get(own, []):
                yield path, number, f"{own} may not include {included}"


def words(root):
    """The library knows neither the command line nor documents nor drawing programs."""
    for path in files(root, "include", "src"):
        for number, line in lines(path):
            for word in ("json", "gnuplot"):
                if word in line.lower():
                    yield path, number, f"names {word}"
            for text in STRING.findall(line):
                if re.search(r"(^|[^-\w])--[a-z]", text.strip('"')):
                    yield path, number, f"names an option of the command line: {text}"


def sizes(root):
    """One concept per file."""
    for path in files(root, "include", "src", "apps", "bindings", "tests", "benchmarks", "fuzz"):
        count = len(path.read_text(encoding="utf-8").splitlines())
        if count > MOST_LINES:
            yield path, count, f"has more than {MOST_LINES} lines"
    users = {}
    for path in files(root, "src", "apps"):
        for _, included in includes(path):
            users.setdefault(included, set()).add(path)
    for base in ("src", "apps"):
        for path in files(root, base):
            name = str(path.relative_to(root / base))
            mine = path.with_suffix(".cpp")
            others = users.get(name, set()) - {mine}
            if path.suffix == ".hpp" and len(others) == 1 and not mine.exists():
                count = len(path.read_text(encoding="utf-8").splitlines())
                if count < 40:
                    print(f"warning: {path.relative_to(root)}: {count} lines, for {next(iter(others)).name} alone")


def names(root):
    """Private headers keep their names to the library."""
    for path in files(root, "src"):
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".hpp" and re.search(r"^(struct|class|enum|inline|constexpr|\[\[nodiscard|template)", text, re.M):
            if "namespace zwidth::internal" not in text:
                yield path, 1, "a private header declares outside of namespace zwidth::internal"


def disk(root):
    """Commands reach files where a request's commands are kept from them: one place to read, one to write."""
    reads = re.compile(r"\b(read_device_file|read_study_file|read_recording|list_recording|read_response_table|fopen|ifstream)\b")
    writes = re.compile(r"\b(OutputFiles|write_whole|make_directory|ofstream)\b")
    for path in files(root, "apps/cli"):
        for number, line in lines(path):
            if reads.search(line) and path.stem != "surroundings":
                yield path, number, "reads a file beside surroundings.hpp"
            if writes.search(line) and path.stem not in ("outputs", "reproduce"):
                yield path, number, "writes a file beside outputs.hpp"


def headers(root):
    """zwidth.hpp has every public header."""
    include = root / "include"
    all_of_them = (include / "zwidth/zwidth.hpp").read_text(encoding="utf-8")
    for path in files(root, "include"):
        if path.name != "zwidth.hpp" and f'#include "{path.relative_to(include).as_posix()}"' not in all_of_them:
            yield path, 1, "zwidth.hpp lacks it"


def main():
    root = Path(sys.argv[1]).resolve()
    rules = {"flow": flow, "words": words, "sizes": sizes, "names": names, "disk": disk, "headers": headers}
    rule = rules[sys.argv[2]]
    broken = list(rule(root))
    for path, number, what in broken:
        print(f"{path.relative_to(root)}:{number}: {what}")
    print(f"{len(broken)} broken")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
