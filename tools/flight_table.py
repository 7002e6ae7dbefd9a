#!/usr/bin/env python3
"""Prints figures of flights side by side: one row for each summary.json, named by its folder.

usage: flight_table.py SUMMARY...
"""
import json
import pathlib
import sys

# heading -> where it is in a summary, how it is written
COLUMNS = {
    "p50 ms": (("frame_ms", "p50"), "{:.2f}"),
    "p99 ms": (("frame_ms", "p99"), "{:.2f}"),
    "triangles": (("draw", "triangles_p50"), "{:.0f}"),
    "draws": (("draw", "draws_p50"), "{:.0f}"),
}


def cell(summary, place, form):
    value = summary
    for key in place:
        value = value.get(key) if isinstance(value, dict) else None
    return "-" if value is None else form.format(value)


def rows(files):
    yield ["path", "picture", *COLUMNS, "device"]
    for file in files:
        if not file.exists():
            yield [file.parent.name, *["-"] * (len(COLUMNS) + 1), "no summary"]
            continue
        summary = json.loads(file.read_text(encoding="utf-8"))
        size = f"{summary['run']['width']}x{summary['run']['height']}"
        figures = [cell(summary, *column) for column in COLUMNS.values()]
        yield [file.parent.name, size, *figures, summary["device"]["name"]]


def main():
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    table = list(rows([pathlib.Path(name) for name in sys.argv[1:]]))
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    for row in table:
        print("  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip())
    return 0


if __name__ == "__main__":
    sys.exit(main())
