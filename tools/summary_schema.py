#!/usr/bin/env python3
"""Makes docs/summary.schema.json from the table of docs/summary.md.

usage: summary_schema.py SOURCE_DIR [--check]     --check only tells whether the file is up to date
"""
import copy
import json
import pathlib
import re
import sys

TYPES = {"text": "string", "integer": "integer", "number": "number", "boolean": "boolean", "object": "object"}
ROW = re.compile(r"^\| `([\w.]+)`( ○)? \| ([^|]*) \| ([^|]*)\| ([^|]*)\| ([^|]*)\|$")


def value_of(kind, nullable, unit, limits, meaning):
    """The schema of one field."""
    schema = {}
    if kind.startswith("list of"):
        items = {"type": "integer" if kind.endswith("integers") else "string"}
        schema = {"type": "array", "items": items}
        count = re.search(r"\d+", kind)
        if count:
            schema |= {"minItems": int(count[0]), "maxItems": int(count[0])}
    else:
        schema["type"] = [TYPES[kind], "null"] if nullable else TYPES[kind]
        items = schema
    if limits:
        low, high = re.fullmatch(r"(?:from )?([\d.]+)(?: to ([\d.]+))?", limits).groups()
        items["minimum"] = json.loads(low)
        if high:
            items["maximum"] = json.loads(high)
    if unit.startswith("16 hex"):
        schema["pattern"] = "^[0-9a-f]{16}$"
    text = "; ".join(part for part in (meaning, unit) if part)
    if text:
        schema["description"] = text
    return schema


def add(schema, names, value):
    """Adds a field to the nested objects of its name. NAME stands for any name."""
    if not names:
        schema.update(value)
        return
    schema.setdefault("type", "object")
    if names[0] == "NAME":
        child = schema.setdefault("additionalProperties", {})
    else:
        child = schema.setdefault("properties", {}).setdefault(names[0], {})
        required = schema.setdefault("required", [])
        if names[0] not in required:
            required.append(names[0])
    add(child, names[1:], value)


def field_at(schema, names):
    """The schema of a field that was added."""
    for name in names:
        schema = schema["properties"][name]
    return schema


def text_of(schema, indent=""):
    """JSON with one field on each line."""
    if not isinstance(schema, dict) or not {"properties", "additionalProperties"} & schema.keys():
        return json.dumps(schema, ensure_ascii=False)
    deeper = indent + "  "
    lines = []
    for key, value in schema.items():
        if key == "properties":
            fields = ",\n".join(f"{deeper}  {json.dumps(name)}: {text_of(field, deeper + '  ')}"
                                for name, field in value.items())
            lines.append(f'{deeper}"properties": {{\n{fields}\n{deeper}}}')
        else:
            lines.append(f"{deeper}{json.dumps(key)}: {text_of(value, deeper)}")
    return "{\n" + ",\n".join(lines) + f"\n{indent}}}"


def schema_of(page):
    rows = [match.groups() for line in page.splitlines() if (match := ROW.match(line))]
    assert len(rows) > 80, "docs/summary.md has no table of fields"
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "psygen.summary/1"}
    for name, nullable, *cells in rows:
        if cells[0].startswith("like "):  # the same fields as another one
            other = cells[0].split("`")[1].split(".")
            add(schema, name.split("."), copy.deepcopy(field_at(schema, other)))
            continue
        add(schema, name.split("."), value_of(cells[0].strip(), nullable, *(cell.strip() for cell in cells[1:])))
    schema["properties"]["schema"]["const"] = schema["title"]
    return text_of(schema) + "\n"


def main():
    root = pathlib.Path(sys.argv[1])
    wanted = schema_of((root / "docs/summary.md").read_text(encoding="utf-8"))
    file = root / "docs/summary.schema.json"
    if "--check" not in sys.argv:
        file.write_text(wanted, encoding="utf-8")
        return 0
    if file.read_text(encoding="utf-8") == wanted:
        return 0
    print("docs/summary.schema.json is not that of docs/summary.md: run tools/summary_schema.py .")
    return 1


if __name__ == "__main__":
    sys.exit(main())
