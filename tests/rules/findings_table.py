#!/usr/bin/python3
"""docs/findings.md: every finding's code, severity, meaning and sentence, from the sources.

usage: findings_table.py ROOT [--write]
Compares the file with what the sources say, or writes it. The meaning is the code's line in finding_code.hpp, the
sentence its phrase in src/words, the severity what the sources make of it.
"""

import re
import sys
from pathlib import Path

SEVERITIES = {"note": "note", "warning": "note", "doubt": "doubt", "refuse": "refusal"}
TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{},;]|\w+')
HEAD = """# Findings

What zwidth may find, as it stands in `findings` of every document that has `trust` or `remarks`:

| key | meaning |
|---|---|
| `code` | what was found: a name below |
| `severity` | `refusal`: no number is given; `doubt`: the number stands, but something does not carry it; `note`: anything else |
| `key` | the device file's, that it concerns; null where there is none |
| `evidence` | the numbers that it rests on by name, with the threshold that they were held to, in SI units |
| `effect` | the limit with it, `critical_stiffness` or `critical_damping`; null where that is not known |
| `remedy` | what to do about it; may be empty |
| `text` | the sentence, as in `trust.reasons` or `remarks` |

Each is listed once, what speaks against the numbers first. One without a severity below stands in a result's `reason`, `why` or
`explanation` alone, in words. A sentence is its code's below; in braces stand its numbers, most of them in
`evidence`, and names. `tests/rules/findings_table.py . --write` writes this file from the sources.

A new finding is a line in `include/zwidth/finding_code.hpp`, a phrase in `src/words/ROOM_phrases.cpp`, and where it is found
`trust.doubt({.code = ..., .evidence = ...})`, `trust.refuse()`, or a remark by `note()` or `warning()`.
"""


def declared(root):
    """(room, code, meaning), in the order of the enum."""
    room = ""
    for line in (root / "include/zwidth/finding_code.hpp").read_text(encoding="utf-8").splitlines():
        if section := re.match(r"  // ([\w ]+)", line):
            room = section[1]
        elif code := re.match(r"  (\w+),\s*///< (.+)", line):
            yield room, code[1], code[2]
        elif more := re.match(r"\s+///< (.+)", line):
            raise SystemExit(f"finding_code.hpp: one line a code: {more[1]}")


def tokens_until(source, begin, end):
    """Literals that follow each other are one; commas are left out."""
    found, is_open = [], False
    for token in TOKEN.finditer(source, begin):
        if token[0] == end:
            return found
        if token[0].startswith('"'):
            text = token[0][1:-1].replace('\\"', '"')
            found = [*found[:-1], found[-1] + text] if is_open else [*found, text]
        elif token[0] != ",":
            found.append(token[0])
        is_open = token[0].startswith('"')
    return found


def phrases(root):
    """Sentence by code."""
    found = {}
    for path in sorted((root / "src/words").glob("*_phrases.cpp")):
        source = path.read_text(encoding="utf-8")
        names = {each[1]: tokens_until(source, each.end(), ";")[0] for each in re.finditer(r"const char\* (\w+) =", source)}
        for each in re.finditer(r"Phrase{", source):
            code, name, *parts = tokens_until(source, each.end(), "}")
            if code != name:
                raise SystemExit(f"{path.name}: {code} is named {name}")
            found[code] = "; ".join(names.get(part, part) for part in parts if part)
    return found


def severities(root, codes):
    """What the calls around a code make of it: note(), warning(), doubt() or refuse(), by way of a helper or a variable."""
    found = {}
    paths = [path for base in ("src", "apps") for path in sorted((root / base).rglob("*.cpp")) if "words" not in path.parts]
    sources = [path.read_text(encoding="utf-8") for path in paths]
    sources = [source for source in sources if "Finding" in source or "finding" in source]
    named = re.compile(rf'(?:FindingCode::|(?<![:.\w"]))({"|".join(codes)})\b(?!\()')
    for source in sources:
        if "FindingCode" in source:
            for mention in named.finditer(source):
                found.setdefault(mention[1], set()).update(made_of(source, mention.start(), sources))
    return found


def calls_around(source, place):
    """Names of the calls whose parentheses are open there, innermost first."""
    depth = 0
    for i in range(place - 1, -1, -1):
        if source[i] in ")}":
            depth += 1
        elif source[i] in "({" and depth > 0:
            depth -= 1
        elif source[i] == "(":
            if name := re.search(r"(\w+)$", source[:i]):
                yield name[1]
        elif source[i] == ";" and depth == 0:
            return


def made_of(source, place, sources):
    for name in calls_around(source, place):
        if name in SEVERITIES:
            return {SEVERITIES[name]}
        if within := body_of(source, name):
            if made := {SEVERITIES[each] for each in re.findall(r"\b(note|warning|doubt|refuse)\(", within)}:
                return made
    end = source.find("\n}", place)
    before = source[max(source.rfind("\n}", 0, place), 0) : place]
    variables = re.findall(r"Finding (\w+)[{ =]|(\w+)\.code = [^;]*$", before)
    for name in [first or then for first, then in variables][-1:]:
        if made := {SEVERITIES[each] for each in re.findall(rf"\b(note|warning|doubt|refuse)\([^;]*?\b{name}\b", source[place:end])}:
            return made
    if header := re.findall(r"\n(?:std::optional<Finding>|Finding) (\w+)\(", before):
        return {SEVERITIES[each] for text in sources if header[-1] in text for each in by_way_of(text, header[-1])}
    return set()


def body_of(source, name):
    """Of the function or lambda of this name in the file."""
    begun = re.search(rf"(?:\b{name} = \[|\n[^\n;]*\b{name}\([^;{{}}]*\) {{)", source)
    return source[begun.start() : source.find("\n}" if "= [" not in begun[0] else ";\n", begun.end())] if begun else ""


def by_way_of(text, function):
    yield from re.findall(rf"\b(note|warning|doubt|refuse)\([^;]*\b{function}\(", text)
    for name in re.findall(rf"auto (\w+) = {function}\(", text):
        yield from re.findall(rf"\b(note|warning|doubt|refuse)\([^;]*\b{name}\b", text)


def table(root):
    codes = list(declared(root))
    sentences, severity = phrases(root), severities(root, [code for _, code, _ in codes])
    text, last = HEAD, None
    for room, code, meaning in codes:
        if room != last:
            text += f"\n## {room[0].upper()}{room[1:]}\n\n| code | severity | meaning | sentence |\n|---|---|---|---|\n"
            last = room
        if code not in sentences:
            raise SystemExit(f"{code} has no phrase in src/words")
        kinds = ", ".join(sorted(severity.get(code, ()), key=["note", "doubt", "refusal"].index))
        text += f"| `{code}` | {kinds} | {meaning} | {sentences[code]} |\n"
    return text


def main():
    root = Path(sys.argv[1])
    file = root / "docs/findings.md"
    if sys.argv[2:] == ["--write"]:
        file.write_text(table(root), encoding="utf-8")
    elif not file.exists() or file.read_text(encoding="utf-8") != table(root):
        raise SystemExit("docs/findings.md is not what the sources say: tests/rules/findings_table.py . --write")


if __name__ == "__main__":
    main()
