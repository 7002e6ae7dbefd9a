#!/usr/bin/env python3
"""Draws the simulation of `psygen schedule --ranks`, with the same bytes on every machine:
  cluster.svg   efficiency and the busiest shared part over the number of ranks
  balance.svg   when ranks end whose blocks cost 1 to 100: a forest in the corner of a desert

usage: cluster_plot.py PSYGEN [FOLDER]        FOLDER: docs/images
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

RANKS = [1, 4, 16, 64, 256, 512, 1024, 2048, 4096, 8192]
CASES = [("8 TB", ["--terabytes", "8"], "#1f77b4"), ("1 EB", ["--terabytes", "1e6"], "#d62728")]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 720, 360, 60, 40, 20, 50


def figures(psygen, ranks, options):
    out = subprocess.run([psygen, "schedule", "--ranks", str(ranks), "--threads", "2", "--json", *options],
                         check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def x_of(ranks):
    return LEFT + (WIDTH - LEFT - RIGHT) * math.log2(ranks) / math.log2(RANKS[-1])


def y_of(percent):
    return TOP + (HEIGHT - TOP - BOTTOM) * (1 - percent / 100)


def text(x, y, words, anchor="middle", colour="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


def line(points, colour, dash=""):
    path = " ".join(f"{x_of(r):.1f},{y_of(p):.1f}" for r, p in points)
    style = f' stroke-dasharray="{dash}"' if dash else ""
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"{style}/>'


def efficiency_plot(psygen):
    parts = [text(WIDTH / 2, 18, "efficiency (lines) and the busiest shared part, files created (dashes), over ranks of one core")]
    for percent in range(0, 101, 20):
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y_of(percent):.1f}" y2="{y_of(percent):.1f}" stroke="#ddd"/>')
        parts.append(text(LEFT - 8, y_of(percent) + 4, f"{percent} %", "end"))
    for ranks in RANKS:
        parts.append(text(x_of(ranks), HEIGHT - BOTTOM + 18, f"{ranks}"))
    for i, (name, options, colour) in enumerate(CASES):
        rows = [(ranks, figures(psygen, ranks, options)) for ranks in RANKS]
        parts.append(line([(r, 100 * f["efficiency"]) for r, f in rows], colour))
        parts.append(line([(r, 100 * f["limits"]["metadata (files created)"]["busy"]) for r, f in rows], colour, "5 4"))
        parts.append(text(LEFT + 20, TOP + 30 + 18 * i, name, "start", colour))
    return parts


def mask_png():
    """A picture of 4 by 4 pixels, white in the upper left corner alone."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes([255 if x == z == 0 else 0 for x in range(4)]) for z in range(4))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


FOREST = """format = 1
[world]
name = "forest in a desert"
seed = 3
blocks = [64, 64]
block_vertices = 8
cell_m = 6
[terrain]
octaves = 1
[[scatter]]
model = "tree"
count = 40
iterations = 4
branches = 3
mask_image = "mask.png"
"""


def balance_plot(psygen):
    shares = [("count", "by count", "#999"), ("cost", "by predicted cost", "#1f77b4"), ("claims", "with claims", "#2ca02c")]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "mask.png").write_bytes(mask_png())
        (folder / "forest.toml").write_text(FOREST, encoding="utf-8")
        rows = [figures(psygen, 8, ["--world", folder / "forest.toml", "--terabytes", "0.02", "--file-latency-ms", "0", "--share", share])
                for share, _, _ in shares]
    longest = max(row["makespan_seconds"] for row in rows)
    parts = [text(WIDTH / 2, 18, "time until each of 8 ranks ends: a forest in the corner of a desert, off by up to 20 %")]
    high = (HEIGHT - TOP - 20) / len(rows)
    for i, ((_, name, colour), row) in enumerate(zip(shares, rows)):
        top = TOP + i * high
        idle = f"{name}: the idlest rank waits {100 * row['worst_rank_idle']:.1f} % of the time"
        parts.append(text(LEFT, top + 10, idle, "start", colour))
        for rank, end in enumerate(row["rank_end_seconds"]):
            width = (WIDTH - LEFT - RIGHT) * end / longest
            parts.append(f'<rect x="{LEFT}" y="{top + 16 + rank * 9:.1f}" width="{width:.1f}" height="7" fill="{colour}"/>')
    return parts


def main():
    psygen = sys.argv[1]
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/images")
    for name, plot in (("cluster.svg", efficiency_plot), ("balance.svg", balance_plot)):
        parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
                 f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', *plot(psygen), "</svg>\n"]
        (folder / name).write_text("\n".join(parts), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
