#!/usr/bin/env python3
"""Compares the laps of a looped flight: the first synthesises, the others find their meshes cached.

usage: lap_table.py LAP_SECONDS FRAMES_CSV

Frames that are apart (docs/cli.md), such as those that were written, are left out. LAP_SECONDS is the length of the path. The first second of each lap is left out: it begins with a
jump. The last column is p50 and p99 of the first lap over those of the second.
"""
import csv
import math
import sys

WARM_UP_S = 1.0


def percentile(values, share):
    values = sorted(values)
    return values[max(0, math.ceil(share * len(values)) - 1)]


def laps_of(frames, lap_s):
    laps = {}
    for frame in frames:
        lap, at_s = divmod(float(frame["time_s"]), lap_s)
        if at_s >= WARM_UP_S and not frame.get("apart"):
            laps.setdefault(int(lap), []).append(frame)
    return [laps[lap] for lap in sorted(laps)]


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    with open(sys.argv[2], encoding="utf-8", newline="") as file:
        laps = laps_of(csv.DictReader(file), float(sys.argv[1]))
    figures = []
    print("lap  frames  p50 ms  p99 ms  triangles  holes  models synthesised")
    for number, lap in enumerate(laps, 1):
        ms = [float(frame["frame_ms"]) for frame in lap]
        figures.append((percentile(ms, 0.5), percentile(ms, 0.99)))
        triangles = percentile([float(frame["triangles"]) for frame in lap], 0.5)
        holes = sum(float(frame["holes"]) > 0 for frame in lap)
        made = sum(float(frame["models_synthesised"]) for frame in lap)
        print(f"{number:3}  {len(lap):6}  {figures[-1][0]:6.2f}  {figures[-1][1]:6.2f}"
              f"  {triangles:9.0f}  {holes:5}  {made:18.0f}")
    if len(figures) > 1:
        print("first / second: p50 {:.3f}, p99 {:.3f}".format(
            *(first / second for first, second in zip(figures[0], figures[1]))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
