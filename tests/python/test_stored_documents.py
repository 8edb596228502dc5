"""What reads the documents of the last release reads those of this one: no key is gone, no type, number or code is another.

tests/data/documents holds a document of every command, commands.json the command lines and what changed since, with its reason. Long
arrays are stored by their beginning and the count of the rest; sentences are not compared. ZWIDTH_WRITE_DOCUMENTS=1 stores what the program
prints, for a release: "changed" then keeps only what is another in every run.
"""

import fnmatch
import json
import os
import re

import pytest
from command_line import answers
from conftest import ROOT

STORED = ROOT / "tests/data/documents"
LISTED = json.loads((STORED / "commands.json").read_text())
DOCUMENTS, CHANGED = LISTED["documents"], LISTED["changed"]
TOLERANCE = 1e-12  # relative
KEPT = 8  # elements of a longer array, in a document of more than LONG bytes
LONG = 8000


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    lines = [line.split() + ([] if line.startswith("export") else ["--json"]) for line in DOCUMENTS.values()]
    told = [text for text, _ in answers(lines, tmp_path_factory.mktemp("stored"))]
    if os.environ.get("ZWIDTH_WRITE_DOCUMENTS"):
        for name, text in zip(DOCUMENTS, told):
            document = shortened(json.loads(text)) if len(text) > LONG else json.loads(text)
            (STORED / f"{name}.json").write_text(json.dumps(document, separators=(",", ":")) + "\n")
    return dict(zip(DOCUMENTS, map(json.loads, told)))


def shortened(value):
    if isinstance(value, dict):
        return {key: shortened(each) for key, each in value.items()}
    if not isinstance(value, list):
        return value
    kept = [shortened(each) for each in (value if len(value) <= KEPT + 1 else value[:KEPT])]
    return [*kept, {"and_more": len(value) - KEPT}] if len(kept) < len(value) else kept


def kind(value):
    return "number" if isinstance(value, (int, float)) and not isinstance(value, bool) else type(value).__name__


def is_sentence(value):
    return isinstance(value, str) and " " in value


def by_parameter(values):
    """What concerns parameters may come in another order."""
    seen, found = {}, {}
    for each in values:
        parameter = each["parameter"]
        seen[parameter] = seen.get(parameter, 0) + 1
        found[parameter if seen[parameter] == 1 else f"{parameter}#{seen[parameter]}"] = each
    return found


def differences(old, new, path=""):
    """Of what is stored from what is printed: path, stored, printed."""
    if kind(old) != kind(new):
        yield path, old, new
    elif isinstance(old, dict):
        for key, value in old.items():
            if key in new:
                yield from differences(value, new[key], f"{path}.{key}")
            else:
                yield f"{path}.{key}", value, "no such key"
    elif isinstance(old, list):
        yield from differences_of_arrays(old, new, path)
    elif kind(old) == "number":
        if abs(old - new) > TOLERANCE * abs(old):
            yield path, old, new
    elif old != new and not (is_sentence(old) and is_sentence(new)):
        yield path, old, new


def differences_of_arrays(old, new, path):
    if old and all(isinstance(each, dict) and "parameter" in each for each in [*old, *new]):
        found = by_parameter(new)
        for name, each in by_parameter(old).items():
            if name in found:
                yield from differences(each, found[name], f"{path}[{name}]")
            else:
                yield f"{path}[{name}]", each, "no such element"
        return
    if old and isinstance(old[-1], dict) and "and_more" in old[-1]:
        count, old = len(old) - 1 + old[-1]["and_more"], old[:-1]
    else:
        count = len(old)
    if count != len(new) and not all(map(is_sentence, [*old, *new])):
        yield path, f"{count} elements", f"{len(new)} elements"
    for i, (each, other) in enumerate(zip(old, new)):
        yield from differences(each, other, f"{path}[{i}]")


def reasons_for(name, path):
    """The entries of "changed" for a path: DOCUMENTS .PATH, elements of arrays counted only where it counts them."""
    plain = re.sub(r"\[[^]]*\]", "", path)
    for entry in CHANGED:
        documents, changed = entry.split(" ")
        if fnmatch.fnmatchcase(name, documents) and ((path if "[" in changed else plain) + ".").startswith(changed + "."):
            yield entry


def all_differences(name, printed):
    stored = json.loads((STORED / f"{name}.json").read_text())
    return list(differences(stored, printed[name]))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_keys_types_numbers_and_codes_stay(name, printed):
    wrong = [each for each in all_differences(name, printed) if not list(reasons_for(name, each[0]))]
    assert not wrong, "\n".join(f"{path}: stored {str(old)[:120]}, printed {str(new)[:120]}" for path, old, new in wrong)


def test_only_what_changed_is_listed_as_changed(printed):
    met = {entry for name in DOCUMENTS for path, _, _ in all_differences(name, printed) for entry in reasons_for(name, path)}
    assert met == set(CHANGED)


def test_every_schema_has_a_document(printed):
    published = {path.name.removesuffix(".1.json") + "/1" for path in (ROOT / "docs/schemas").glob("*.json")}
    assert {document["schema"] for document in printed.values()} == published


def test_what_is_gone_or_other_is_noticed():
    old = {"k": 1.0, "code": "mode", "text": "a b", "list": [1, 2, {"and_more": 2}], "of": [{"parameter": "a", "v": 1}, {"parameter": "b", "v": 2}]}
    new = {"k": 1.0 + 1e-13, "code": "mode", "text": "c d", "list": [1, 2, 3, 4], "of": [{"parameter": "b", "v": 2}, {"parameter": "a", "v": 1}]}
    assert not list(differences(old, new))
    for other in ({"k": 1.0 + 1e-11}, {"k": "1"}, {"k": None}, {"code": "body"}, {"list": [1, 2, 3]}, {"list": [1, 3, 3, 4]}, {"of": new["of"][:1]}):
        assert len(list(differences(old, {**new, **other}))) == 1, other
    assert [path for path, _, _ in differences(old, {key: value for key, value in new.items() if key != "k"})] == [".k"]
