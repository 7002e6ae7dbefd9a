#!/usr/bin/env python3
"""Tests tools/flight_table.py and tools/lap_table.py on known numbers.

usage: tables_test.py SOURCE_DIR
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

SYSTEMS = ["input", "daylight", "streaming", "visibility", "cache", "synthesis", "upload", "render", "telemetry"]
SUMMARY = {
    "device": {"name": "a device"},
    "run": {"width": 640, "height": 360, "warmup_seconds": 1.0},
    "frame_ms": {"p50": 12.34, "p99": 23.45},
    "hitches": 3,
    "missing": {"frames": 2, "pixels_p99_percent": 0.5, "time_to_visible_ms": {"p99": None}},
    "cache": {"peak_bytes": 7 << 20},
    "memory": {"peak_rss_bytes": 300 << 20},
    "draw": {"triangles_p50": 1234.0, "draws_p50": 56.0, "floor_ratio": 1.05},
}


def write_frames(file, frames):
    """`frames` are time, length in ms, of which every system takes a tenth, and the reason of an exclusion."""
    with open(file, "w", encoding="utf-8", newline="") as lines:
        rows = csv.writer(lines)
        rows.writerow(["time_s", "frame_ms", "main_cpu_ms", "apart", "triangles", "holes", "models_synthesised",
                       *(f"{name}_ms" for name in SYSTEMS)])
        for time_s, ms, *apart in frames:
            rows.writerow([time_s, ms, ms / 2, "".join(apart), 100, 0, 1, *[ms / 10] * len(SYSTEMS)])


def output_of(tool, *arguments):
    return subprocess.run([sys.executable, tool, *arguments], check=True, capture_output=True, text=True).stdout


def main():
    tools = pathlib.Path(sys.argv[1]) / "tools"
    with tempfile.TemporaryDirectory() as folder:
        flight = pathlib.Path(folder) / "flight"
        flight.mkdir()
        (flight / "summary.json").write_text(json.dumps(SUMMARY), encoding="utf-8")
        # Statistics exclude the 50 ms of the warm-up and of the image; 2 of 100 frames take 20 ms, the others 10.
        write_frames(flight / "frames.csv", [(0.5, 50), (1.5, 500, "picture"), *((1 + i / 100, 10 if i < 98 else 20) for i in range(100))])
        lines = output_of(tools / "flight_table.py", flight / "summary.json", flight.parent / "none/summary.json")
        heading, row, missing = lines.splitlines()
        cells = row.split()
        expected = ["flight", "640x360", "12.3", "23.4", "3", "2", "0.50", "-", "1.05", "7", "300", "1234", "56",
                    "16.00", "10.00", "a", "device"]
        assert cells == expected, f"{cells} instead of {expected}"
        assert "no summary" in missing and heading.startswith("path"), lines
        (flight / "frames.csv").unlink()
        assert " - " in output_of(tools / "flight_table.py", flight / "summary.json").splitlines()[1]

        frames = [(lap * 3 + 1.5 + i / 100, 12 if lap == 0 else 10) for lap in range(2) for i in range(100)]
        write_frames(flight / "frames.csv", [(0.5, 90), (2.0, 300, "picture"), (3.5, 80), *frames])
        laps = output_of(tools / "lap_table.py", "3", flight / "frames.csv")
        assert "p50 1.200, p99 1.200" in laps, laps
        assert laps.splitlines()[1].split() == ["1", "100", "12.00", "12.00", "100", "0", "100"], laps
    return 0


if __name__ == "__main__":
    sys.exit(main())
