"""zwidth/_documents.py: a class per document of docs/schemas, its keys as attributes with what they mean.

usage: documents.py SCHEMAS OUTPUT
"""

import json
import keyword
import re
import sys
from pathlib import Path

# Parts that are classes of their own, in an order in which none needs a later one; any other is a Record.
PARTS = ["Trust", "Remark", "Finding", "LimitedBy", "Mode", "Crossover", "HolderLimit", "HoldingLimits", "StableFor", "WallMargins", "AnyUser",
         "Curve", "SweepAxis", "SweepPoint", "Quantile", "FitPoints", "BodyMotion", "Motion"]  # fmt: skip
# Parts whose schemas have a title that is another class of the package.
CLASSES = {"Mechanism": "LimitedBy"}
SCALARS = {"string": "text", "boolean": "flag", "integer": "count", "number": "number"}
HEAD = '''"""The documents' keys as attributes. Written by bindings/python/documents.py from docs/schemas."""

from . import _record as _of
from ._record import Record, Result
'''


def types_of(schema):
    if "const" in schema or "enum" in schema and "type" not in schema:
        return {"string"}
    types = schema.get("type", [])
    return {types} if isinstance(types, str) else set(types)


def kind_of(schema):
    """The call that declares it, without its description: "maybe_one(Mode, "."""
    types = types_of(schema)
    maybe, types = "maybe_" * ("null" in types), types - {"null"}
    if len(types) != 1:
        return "anything("
    (type,) = types
    if type in SCALARS:
        return "maybe(" if maybe and type == "number" else f"{maybe}{SCALARS[type]}("
    if type == "object":
        return f"{maybe}one({class_of(schema)}, "
    return kind_of_list(schema, schema.get("items", {}))


def kind_of_list(schema, items):
    types = types_of(items) - {"null"}
    if types and types <= {"number", "integer"}:
        return "interval(" if schema.get("maxItems") == 2 else "array("
    if types == {"string"}:
        return "texts("
    if types == {"object"}:
        return f"many({class_of(items)}, "
    if types == {"array"} and items.get("maxItems") == 2:
        return "complexes(" if items.get("title") == "Complex" else "intervals("
    return "anything("


def sentence(description):
    text = re.sub(r"\bnull\b", "None", description)
    return text[0].upper() + text[1:] if re.match(r"[a-z]+\b[^_;]", text) else text


def class_of(schema):
    name = CLASSES.get(schema.get("title"), schema.get("title"))
    return name if name in PARTS else "Record"


def class_text(name, base, schemas, told):
    """Of all that the schemas have of it. A key of a part that not all have is None where it is missing; of a document there is none then."""
    text = f'\n\nclass {name}({base}):\n    """{sentence(told)}."""\n\n'
    for key in dict.fromkeys(key for each in schemas for key in each["properties"]):
        having = [each["properties"][key] for each in schemas if key in each["properties"]]
        kind = next((kind for kind in map(kind_of, having) if kind != "anything("), "anything(")
        declared = f"_of.{kind}{json.dumps(sentence(having[0]['description']), ensure_ascii=False)})"
        if base == "Record" and not all(key in each["required"] for each in schemas):
            declared = f"_of.or_none({declared})"
        text += f"    {key}{'_' * keyword.iskeyword(key)} = {declared}\n"
    return text


def found_in(schema, told, parts):
    """Adds the parts that are classes: (schema, what the key that has it means)."""
    if class_of(schema) != "Record":
        parts.setdefault(class_of(schema), []).append((schema, told))
    for each in schema.get("properties", {}).values():
        found_in(each, each["description"], parts)
    if "items" in schema:
        found_in(schema["items"], told, parts)


def main():
    schemas = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(Path(sys.argv[1]).glob("*.json"))]
    parts = {}
    for schema in schemas:
        found_in(schema, "", parts)
    text = HEAD
    for name in PARTS:
        text += class_text(name, "Record", [schema for schema, _ in parts[name]], parts[name][0][1])
    for schema in schemas:
        name = schema["title"].removeprefix("zwidth.").split("/")[0]
        text += class_text("".join(word.capitalize() for word in name.split("_")), "Result", [schema], f"keys of {schema['title']}")
    Path(sys.argv[2]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
