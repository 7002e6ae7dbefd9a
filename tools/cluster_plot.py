#!/usr/bin/env python3
"""Draws docs/images/cluster.svg: efficiency and the busiest shared part over the number of ranks, as
`psygen schedule --ranks` simulates them. The same bytes on every machine.

usage: cluster_plot.py PSYGEN [OUT.svg]
"""
import json
import math
import pathlib
import subprocess
import sys

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


def main():
    psygen = sys.argv[1]
    out = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/images/cluster.svg")
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
             text(WIDTH / 2, 18, "efficiency (lines) and the busiest shared part, files created (dashes), over ranks of one core")]
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
    out.write_text("\n".join([*parts, "</svg>\n"]), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
