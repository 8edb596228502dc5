#!/usr/bin/python3
"""docs/findings.md: every finding's code, severity, meaning and sentence, from the sources.

usage: findings_table.py ROOT [--write]
Compares the file with what the sources say, or writes it. The meaning is the code's line in finding_code.hpp, the
severity and the sentence its phrase in src/words.
"""

import re
import sys
from pathlib import Path

SEVERITIES = ("note", "warning", "doubt", "refusal")
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

Each is listed once, those that matter most first: refusals, doubts by the lowest limit with one of them, warnings, notes, and last how a
file was read. A remark of what is a doubt already is left out. The severity below is the worst that is made of a code: a doubt may be a remark
where less hangs on it, and the refusal of a part a doubt about the whole; a warning is a `note` in documents. A sentence is its code's
below; in braces stand its numbers, most of them in `evidence`, and names. `tests/rules/findings_table.py . --write` writes this file from
the sources. A code that stands in a `reason`, `why` or `explanation` alone, in words, is a note.

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
    """The worst severity and the sentence, by code."""
    found = {}
    for path in sorted((root / "src/words").glob("*_phrases.cpp")):
        source = path.read_text(encoding="utf-8")
        names = {each[1]: tokens_until(source, each.end(), ";")[0] for each in re.finditer(r"const char\* (\w+) =", source)}
        for each in re.finditer(r"\bPhrase{", source):
            code, name, severity, *parts = tokens_until(source, each.end(), "}")
            if code != name or severity not in SEVERITIES:
                raise SystemExit(f"{path.name}: {code} is named {name}, of severity {severity}")
            found[code] = severity, "; ".join(names.get(part, part) for part in parts if part)
    return found


def table(root):
    known = phrases(root)
    text, last = HEAD, None
    for room, code, meaning in declared(root):
        if room != last:
            text += f"\n## {room[0].upper()}{room[1:]}\n\n| code | severity | meaning | sentence |\n|---|---|---|---|\n"
            last = room
        if code not in known:
            raise SystemExit(f"{code} has no phrase in src/words")
        severity, sentence = known[code]
        text += f"| `{code}` | {severity} | {meaning} | {sentence} |\n"
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
