#!/usr/bin/python3
"""docs/schemas and the tables of docs/*_json.md: every key of every document with what it means.

usage: schemas.py ROOT [--write]
Compares the files with docs/schemas/descriptions.toml, or writes it into them. A key without a description fails, and so does
a description of no key. A key may be null where its description says so.
"""

import json
import re
import sys
import tomllib
from pathlib import Path

MARKED = re.compile(r"(<!-- keys of (zwidth\.\w+/1) -->\n).*?(<!-- until here -->)", re.DOTALL)


class Descriptions:
    """What descriptions.toml says of a key by its path, and what of it was asked for."""

    def __init__(self, root):
        self._tables = tomllib.loads((root / "docs/schemas/descriptions.toml").read_text(encoding="utf-8"))
        self._used = set()

    def of(self, table, path):
        """Under the longest name that ends the path; None where there is none."""
        entries = self._tables[table]
        for begin in range(len(path)):
            name = ".".join(path[begin:])
            if name in entries:
                self._used.add((table, name))
                return entries[name]
        return None

    def unused(self):
        return [f'descriptions.toml: [{table}] "{name}" is no key' for table, all in self._tables.items() for name in all
                if (table, name) not in self._used]  # fmt: skip


def described(schema, told):
    """The schema with the description of every key, and what is told of its values."""
    document = schema["title"].split("/")[0].removeprefix("zwidth.")
    return {**_with_keys(_bare(schema), [document], told), "title": schema["title"]}


def _bare(schema):
    """Without what this script writes: as tests/python/schema_of_documents.py finds it."""
    bare = {key: value for key, value in schema.items() if key not in ("description", "title", "minItems", "maxItems")}
    if "enum" in bare and "type" in bare:
        del bare["enum"]
    if types := [each for each in _types(bare) if each != "null"]:
        bare["type"] = types[0].replace("integer", "number") if len(types) == 1 else types
    if "properties" in bare:
        bare["properties"] = {key: _bare(value) for key, value in bare["properties"].items()}
    return bare | ({"items": _bare(bare["items"])} if "items" in bare else {})


def _with_keys(schema, path, told):
    if title := "properties" in schema and told.of("titles", path):
        schema = {"title": title, **schema}
    if "properties" in schema:
        keys = schema["properties"]
        schema["properties"] = {key: _of_key(keys[told.of("same", [*path, key]) or key], [*path, key], told) for key in keys}
    for key in ("items", "additionalProperties"):
        if isinstance(schema.get(key), dict):
            schema[key] = _with_keys(schema[key], path, told)
    return schema


def _of_key(schema, path, told):
    text = told.of("descriptions", path)
    if not text:
        raise SystemExit(f'docs/schemas/descriptions.toml does not say what "{".".join(path)}" means')
    if type := told.of("types", path):
        schema = {"type": type}
    if values := _types(schema) == ["string"] and told.of("values", path):
        schema = {**schema, "enum": values}
    if "number" in _types(_innermost(schema)):
        if told.of("integers", path):
            schema = _as_integers(schema)
        if pair := told.of("pairs", path):
            schema = _as_pairs(schema, pair)
    schema = _with_null(schema, text)
    return {"description": text, **_with_keys(schema, path, told)}


def _with_null(schema, text):
    """With null among the types where the description says so; of what a list holds where it says so of an end or an entry."""
    whole, of_entries = re.subn(r"\b(end|entry) is null", "", text)
    if of_entries:
        schema = _entries_or_null(schema)
    return _or_null(schema) if re.search(r"\bnull\b", whole) else schema


def _entries_or_null(schema):
    return {**schema, "items": _entries_or_null(schema["items"])} if "items" in schema else _or_null(schema)


def _or_null(schema):
    if not _types(schema) or "null" in _types(schema):
        return schema
    schema = {**schema, "type": [*_types(schema), "null"]}
    return {**schema, "enum": [*schema["enum"], None]} if "enum" in schema else schema


def _types(schema):
    types = schema.get("type", [])
    return [types] if isinstance(types, str) else types


def _innermost(schema):
    return _innermost(schema["items"]) if "items" in schema else schema


def _as_integers(schema):
    return {**schema, "items": _as_integers(schema["items"])} if "items" in schema else {**schema, "type": "integer"}


def _as_pairs(schema, pair):
    if "items" in schema["items"]:
        return {**schema, "items": _as_pairs(schema["items"], pair)}
    return {**({"title": pair} if isinstance(pair, str) else {}), **schema, "minItems": 2, "maxItems": 2}


def key_table(schema):
    """Its keys as rows of Markdown. A part that stands in several places has its keys once, at the uppermost."""
    rows, placed = ["| key | content |", "|---|---|"], {}
    for key, value in schema["properties"].items():
        placed.setdefault(_part(value), key)

    def add(properties, path):
        for key, value in properties.items():
            name, part = f"{path}{key}", _part(value)
            place = "findings.md" if key == "findings" else part and placed.setdefault(part, name)
            text = re.sub(r"docs/(\w+)\.md", r"[\1.md](\1.md)", value["description"].replace("|", "\\|"))
            if key == "findings":
                text += "; keys in [findings.md](findings.md)"
            elif part and place != name:
                text += f"; keys as those of `{place}`"
            rows.append(f"| `{name}` | {text} |")
            if part and place == name:
                add(_innermost(value)["properties"], f"{name}.")

    add(schema["properties"], "")
    return "".join(f"{row}\n" for row in rows)


def _part(schema):
    """What tells the part of a key from others: its keys and what they mean. Empty where it has none."""
    return tuple((key, value["description"]) for key, value in _innermost(schema).get("properties", {}).items())


def files(root, told):
    """(path, what it should be) of each."""
    schemas = {}
    for path in sorted((root / "docs/schemas").glob("*.json")):
        schema = described(json.loads(path.read_text(encoding="utf-8")), told)
        schemas[schema["title"]] = schema
        yield path, json.dumps(schema, indent=1) + "\n"
    for path in sorted((root / "docs").glob("*_json.md")):
        text = path.read_text(encoding="utf-8")
        if not MARKED.search(text):
            raise SystemExit(f"{path.name} has no table of keys: <!-- keys of zwidth.NAME/1 --> ... <!-- until here -->")
        yield path, MARKED.sub(lambda found: found[1] + key_table(schemas[found[2]]) + found[3], text)


def main():
    root = Path(sys.argv[1])
    told = Descriptions(root)
    wrong = []
    for path, text in files(root, told):
        if sys.argv[2:] == ["--write"]:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            wrong.append(f"{path.relative_to(root)} is not what descriptions.toml says: tests/rules/schemas.py . --write")
    if wrong := wrong + told.unused():
        raise SystemExit("\n".join(wrong))


if __name__ == "__main__":
    main()
