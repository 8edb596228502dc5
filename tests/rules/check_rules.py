#!/usr/bin/python3
"""Holds the sources to the rules of CONTRIBUTING.md.

usage: check_rules.py ROOT RULE      RULE: flow, words, sentences, sizes, names, disk, headers or apart
Prints every line that breaks the rule, and exits with 1 where there is one.
"""

import re
import sys
from pathlib import Path

# Room: the rooms that its files may include, besides itself and the public headers that stand in no room.
LIBRARY = {
    "words": ["model", "stability", "design"],  # the problems of a device, the names of who holds it and of what is advised
    "model": [],
    "signal": [],
    "sampling": ["model"],
    "control": ["model", "sampling"],
    "mechanism": ["words", "model"],
    "batch/kernel": ["model", "sampling"],
    "stability": ["model", "sampling", "batch/kernel"],
    "io": ["model", "mechanism", "signal", "study"],
    "workspace": ["words", "model", "mechanism", "stability", "batch"],
    "simulation": ["model", "signal", "sampling", "control", "stability"],
    "identification": ["words", "model", "signal", "sampling", "stability", "simulation"],
    "batch": ["model", "sampling", "stability", "batch/kernel"],
    "design": ["model", "signal", "sampling", "stability", "batch"],
    "study": ["model", "sampling", "stability", "batch", "design"],
    "rig": ["words", "model", "signal", "sampling", "control", "stability", "simulation", "identification"],
}
# Sub-rooms of a room, in their order: each includes those before it. What stands in the room itself includes them all.
SUB_ROOMS = {
    "stability": ["loop", "roots", "second_route", "limit", "users", "margins", "tip"],
    "identification": ["crossover", "response", "initial_fit", "model", "optimiser", "evidence", "verdict"],
    "design": ["region", "sensitivities", "synthesis", "diagnosis"],
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
    "on_demand": ["study", "server"],
}
MOST_LINES = 500
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
# Literals that read as a sentence for a person, outside of words/: the most that a room may have of them. None is the aim, as it
# stands in every room that is not listed.
SENTENCES = {"identification": 2}
KEY_TABLE = "device_keys.cpp"  # the device file's keys, each with its help
UNITS = {"m", "rad", "s", "kg", "ms", "us", "per", "degrees", "samples"}
PROSE = re.compile(r"[(\[]?[a-z][a-z'-]*[a-z][,;:.)\]]*")
STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
STRING_OR_COMMENT = re.compile(STRING.pattern + "|//.*")


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


def sub_room(path):
    """"stability/users/termination_discs.hpp" -> its place in the order; nothing for what stands in the room itself."""
    parts = path.split("/")
    order = SUB_ROOMS.get(parts[0], [])
    return order.index(parts[1]) if len(parts) == 3 and parts[1] in order else None


def flow(root):
    """Includes go where the flow of the house goes; the program and its reports see public headers alone."""
    for base in ("include/zwidth", "src"):
        for path in files(root, base):
            place = str(path.relative_to(root / base))
            own = room_of_library(place)
            for number, included in includes(path):
                room = room_of_library(included)
                if own is None and base == "include/zwidth":
                    continue  # zwidth.hpp
                if room is not None and room != own and room not in LIBRARY.get(own, ["words"]):
                    yield path, number, f"{own} may not include {included}"
                if own in SUB_ROOMS and room == own and not included.startswith("zwidth/"):
                    mine, theirs = sub_room(place), sub_room(included)
                    if mine is not None and (theirs is None or theirs > mine):
                        yield path, number, f"{place.rpartition('/')[0]} may not include {included}"
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


def is_sentence(text):
    """Three words at least beside numbers and units: a name has two."""
    words = re.sub(r"\{[^{}]*\}", " ", text).split(" ")
    return len([each for each in words if PROSE.fullmatch(each) and each.strip("([.,;:)]") not in UNITS]) >= 3


def sentences(root):
    """Sentences for a person are made in words/ alone."""
    found = {}
    for base in ("include/zwidth", "src"):
        for path in files(root, base):
            room = path.relative_to(root / base).parts[0] if path.parent != root / base else "no room"
            for number, line in lines(path) if room != "words" and path.name != KEY_TABLE else ():
                if line.lstrip().startswith(("#", "static_assert")):
                    continue
                for text in STRING_OR_COMMENT.findall(line):
                    if text.startswith('"') and is_sentence(text.strip('"')):
                        found.setdefault(room, []).append((path, number, f"a sentence outside of words/: {text}"))
    for room, lines_of_room in found.items():
        if len(lines_of_room) > SENTENCES.get(room, 0):
            yield from lines_of_room


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
            if reads.search(line) and path.stem != "request_context":
                yield path, number, "reads a file beside request_context.hpp"
            if writes.search(line) and path.stem not in ("outputs", "reproduce"):
                yield path, number, "writes a file beside outputs.hpp"


# The header of each name of the standard library that public headers may use.
STANDARD = {
    "array": "array", "complex": "complex", "function": "functional", "int16_t": "cstdint", "int8_t": "cstdint", "isnan": "cmath", "map": "map", "move": "utility",
    "nullopt": "optional", "numbers": "numbers", "numeric_limits": "limits", "optional": "optional", "runtime_error": "stdexcept",
    "shared_ptr": "memory", "size_t": "cstddef", "span": "span", "string": "string", "string_view": "string_view",
    "uint16_t": "cstdint", "uint32_t": "cstdint", "uint64_t": "cstdint", "uint8_t": "cstdint", "unique_ptr": "memory", "vector": "vector",
}  # fmt: skip


def included_by(path, include, seen):
    """The headers in <> that a public header includes, itself or through others of the project."""
    seen.add(path)
    text = path.read_text(encoding="utf-8")
    found = set(re.findall(r"#include <([^>]+)>", text))
    for other in re.findall(r'#include "([^"]+)"', text):
        if (other_path := include / other) not in seen and other_path.exists():
            found |= included_by(other_path, include, seen)
    return found


def headers(root):
    """zwidth.hpp, with core.hpp, has every public header; each includes what it names of the standard library and of Eigen (the build compiles each
    alone, but with their headers compiled before)."""
    include = root / "include"
    for path in files(root, "include"):
        included = included_by(path, include, set())
        for number, line in lines(path):
            if "Eigen::" in line.partition("//")[0] and "Eigen/Core" not in included:
                yield path, number, "Eigen:: without <Eigen/Core>"
            for name in re.findall(r"\bstd::(\w+)", line.partition("//")[0]):
                if name not in STANDARD:
                    yield path, number, f"std::{name} is not in the table STANDARD of check_rules.py"
                elif STANDARD[name] not in included:
                    yield path, number, f"std::{name} without <{STANDARD[name]}>"
    all_of_them = "".join((include / "zwidth" / name).read_text(encoding="utf-8") for name in ("zwidth.hpp", "core.hpp"))
    for path in files(root, "include"):
        if path.name != "zwidth.hpp" and f'#include "{path.relative_to(include).as_posix()}"' not in all_of_them:
            yield path, 1, "zwidth.hpp lacks it"


def apart(root):
    """What is known of a finding or a problem stands in its fields: nothing looks for it in the sentence."""
    part = r"(?:what|allowed|remedy|consequence|meaning|message|reason|sentence)"
    asks = r"(?:r?find\w*|split|substr\w*|slice|starts_with|ends_with|startsWith|endsWith|includes|indexOf|match|search)\("
    taken = re.compile(rf"\b{part}(?:\(\))?!?(?:\.|->|\?\.)(?:{asks}|replace(?:All)?\([\"'/])|\.test\([^)]*\b{part}\b")
    # CLI11 and nlohmann-json tell by their messages alone.
    others = ("usage_error.cpp", "request_problem.cpp", "request_document.cpp")
    paths = [*files(root, "include", "src", "apps", "bindings"), *(root / "bindings").rglob("*.py")]
    paths += [path for path in sorted((root / "web/src").rglob("*")) if path.suffix in (".ts", ".svelte")]
    for path in paths:
        for number, line in lines(path):
            if taken.search(line) and "'\\n'" not in line and path.name not in others:
                yield path, number, f"takes a sentence apart: {line.strip()}"


def main():
    root = Path(sys.argv[1]).resolve()
    rules = {"flow": flow, "words": words, "sentences": sentences, "sizes": sizes, "names": names, "disk": disk, "headers": headers}
    rules["apart"] = apart
    rule = rules[sys.argv[2]]
    broken = list(rule(root))
    for path, number, what in broken:
        print(f"{path.relative_to(root)}:{number}: {what}")
    print(f"{len(broken)} broken")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
