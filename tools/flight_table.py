#!/usr/bin/env python3
"""Prints figures of flights side by side: one row for each summary.json, named by its folder.

usage: flight_table.py SUMMARY...

The columns: median and p99 of frame times, hitches, frames with a hole, share of the picture that
lacks something or has it more than one level too coarse (p99, percent), time from visible to drawn
(p99), frame time over its floor, peak of the cache and of resident memory, triangles and draws of
a frame (medians). From the frames.csv beside the summary: what all systems but drawing take of a
tick, by the clock, and processor time of the main thread in a frame, drawing included (p99 each).
"""
import csv
import json
import math
import pathlib
import sys

# heading -> field of the summary, its format, and its divisor
COLUMNS = {
    "p50 ms": (("frame_ms", "p50"), "{:.1f}", 1),
    "p99 ms": (("frame_ms", "p99"), "{:.1f}", 1),
    "hitches": (("hitches",), "{:.0f}", 1),
    "holes": (("missing", "frames"), "{:.0f}", 1),
    "coarse %": (("missing", "pixels_p99_percent"), "{:.2f}", 1),
    "visible ms": (("missing", "time_to_visible_ms", "p99"), "{:.0f}", 1),
    "floor": (("draw", "floor_ratio"), "{:.2f}", 1),
    "cache MiB": (("cache", "peak_bytes"), "{:.0f}", 1 << 20),
    "memory MiB": (("memory", "peak_rss_bytes"), "{:.0f}", 1 << 20),
    "triangles": (("draw", "triangles_p50"), "{:.0f}", 1),
    "draws": (("draw", "draws_p50"), "{:.0f}", 1),
}
SYSTEMS = ("input", "daylight", "streaming", "visibility", "cache", "synthesis", "upload", "telemetry")
OF_FRAMES = ("systems ms", "main cpu ms")


def cell(summary, place, form, unit):
    value = summary
    for key in place:
        value = value.get(key) if isinstance(value, dict) else None
    return "-" if value is None else form.format(value / unit)


def percentile(values, share):
    """Percentiles as in summary.json (engine/telemetry/statistics.hpp): between the two nearest values."""
    values = sorted(values)
    at = share * (len(values) - 1)
    below = math.floor(at)
    above = min(below + 1, len(values) - 1)
    return values[below] + (at - below) * (values[above] - values[below])


def of_frames(file, warm_up_s):
    """p99 of a sum that no summary has, over the frames after the warm-up that statistics include."""
    if not file.exists():
        return ["-"] * len(OF_FRAMES)
    with open(file, encoding="utf-8", newline="") as lines:
        frames = [row for row in csv.DictReader(lines)
                  if float(row["time_s"]) >= warm_up_s and not row.get("apart")]
    if not frames:
        return ["-"] * len(OF_FRAMES)
    systems = [sum(float(row[f"{name}_ms"]) for name in SYSTEMS) for row in frames]
    main = [float(row["main_cpu_ms"]) for row in frames]
    return [f"{percentile(values, 0.99):.2f}" for values in (systems, main)]


def rows(files):
    yield ["path", "picture", *COLUMNS, *OF_FRAMES, "device"]
    for file in files:
        if not file.exists():
            yield [file.parent.name, *["-"] * (len(COLUMNS) + len(OF_FRAMES) + 1), "no summary"]
            continue
        summary = json.loads(file.read_text(encoding="utf-8"))
        run = summary["run"]
        figures = [cell(summary, *column) for column in COLUMNS.values()]
        figures += of_frames(file.parent / "frames.csv", run.get("warmup_seconds") or 0)
        yield [file.parent.name, f"{run['width']}x{run['height']}", *figures, summary["device"]["name"]]


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
