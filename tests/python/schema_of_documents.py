"""The JSON Schema that documents of one kind have in common: what docs/schemas is written from."""

import sys
from collections import defaultdict

from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests/rules"))

from schemas import Descriptions, described  # noqa: E402

NULL = type(None)
VERDICTS = ["sound", "doubtful", "refused"]  # of "trust", whichever were seen
NUMBERS = {"additionalProperties": {"type": ["number", "null"]}}  # by their names
FINDING = {  # whichever were seen
    "code": {"type": "string"},
    "severity": {"enum": ["note", "doubt", "refusal"]},
    "key": {"type": ["string", "null"]},
    "evidence": {"type": "object", **NUMBERS},
    "effect": {"type": ["object", "null"], **NUMBERS},
    "remedy": {"type": "string"},
    "text": {"type": "string"},
}
REMARK = {key: {"type": "string"} for key in ("severity", "what", "meaning", "consequence", "remedy")}


def list_of(properties):
    return {"type": "array", "items": {"type": "object", "properties": properties, "required": list(properties), "additionalProperties": False}}


def schema_of(values, key=""):
    """Every number may be null, as a number that does not exist is; else only what was null somewhere."""
    if key in ("findings", "remarks"):
        return list_of(FINDING if key == "findings" else REMARK)
    kinds = defaultdict(list)
    for value in values:
        kind = float if isinstance(value, int) and not isinstance(value, bool) else type(value)
        kinds[kind].append(value)
    if float in kinds:
        kinds.setdefault(NULL, [])
    names = {str: "string", float: "number", bool: "boolean", NULL: "null", dict: "object", list: "array"}
    types = [name for kind, name in names.items() if kind in kinds]
    if types in ([], ["null"]):
        return {}  # nothing is known of it
    schema = {"type": types[0] if len(types) == 1 else types}
    if dict in kinds:
        schema |= object_schema(kinds[dict])
    if list in kinds:
        items = {"type": "string"} if key == "reasons" else schema_of([item for value in kinds[list] for item in value], key)
        if items:
            schema["items"] = items
    if key == "verdict" and types == ["string"] and set(kinds[str]) <= set(VERDICTS):
        schema = {"enum": VERDICTS}
    return schema


def object_schema(objects):
    keys = dict.fromkeys(key for each in objects for key in each)
    if any("." in key for key in keys):  # by the keys of device files
        return {"additionalProperties": schema_of([value for each in objects for value in each.values()])}
    return {
        "properties": {key: schema_of([each[key] for each in objects if key in each], key) for key in keys},
        "required": [key for key in keys if all(key in each for each in objects)],
        "additionalProperties": False,
    }


def published(name, documents):
    """The schema of documents whose "schema" is this name."""
    schema = schema_of(documents)
    schema["properties"]["schema"] = {"const": name}
    return described({"$schema": "https://json-schema.org/draft/2020-12/schema", "title": name, **schema}, Descriptions(ROOT))
