#!/usr/bin/env python3
"""Writes paper.html from the results of tools/reproduce_paper.sh: plots, tables, text, and the machine.

usage: reproduction_page.py FOLDER QUICK     (QUICK: 1 on the virtual clock)

Style and script of the plots are those of the reports in the folder.
"""
import csv
import html
import json
import os
import pathlib
import platform
import re
import sys

BIN_S = 0.25  # of the frame rates in the plots
CONFIGURATIONS = [("one_core", "one core"), ("two_cores", "two cores"),
                  ("one_of_two", "two cores, one of them off")]
PARADIGMS = [("paradigm_amplify", "data amplification"), ("paradigm_lazy", "lazy evaluation"),
             ("paradigm_pla", "parallel lazy amplification")]
# Facts of the paper about its world, and their fields of a summary.
WORLD = [("blocks", "512 × 512", lambda w: "{} × {}".format(*w["blocks"])),
         ("models on a block", "23 trees, 40 rocks", lambda w: f"{w['block']['models']:.0f}"),
         ("triangles of a block", "about 125,000", lambda w: f"{w['block']['triangles']:,.0f}"),
         ("triangles", "32,768,000,000", lambda w: f"{w['triangles']:,}"),
         ("at 256 bytes a triangle", "about 8 TB", lambda w: f"{w['bytes_paper'] / 1e12:.2f} TB"),
         ("in this engine's formats", "", lambda w: f"{w['bytes'] / 1e12:.2f} TB")]


def text(value):
    return html.escape(str(value))


def number(value, form="{:.1f}"):
    return "–" if value is None else form.format(value)


class Run:
    """A folder of a flight; `failed` is its message, or None."""

    def __init__(self, folder):
        self.command = (folder / "command").read_text().strip()
        self.failed = None
        self.bins = {}
        self.summary = None
        if (folder / "failed").exists():
            lines = (folder / "log").read_text(errors="replace").strip().splitlines()
            self.failed = lines[-1] if lines else "it failed"
            return
        self.summary = json.loads((folder / "summary.json").read_text())
        if not (folder / "frames.csv").exists():
            return
        with open(folder / "frames.csv", encoding="utf-8", newline="") as lines:
            self.frames = list(csv.DictReader(lines))
        for row in self.frames:
            if row["apart"]:
                continue
            sums = self.bins.setdefault(int(float(row["time_s"]) / BIN_S), [0, 0.0, 0.0])
            sums[0] += 1
            sums[1] += float(row["frame_ms"])
            sums[2] = max(sums[2], float(row["missing_pixels_percent"]), float(row["too_coarse_percent"]))

    def fps(self, index):
        """Values of the frames that begin in a bin. A frame longer than a bin continues in the next."""
        while index >= 0 and index not in self.bins:
            index -= 1
        return 1000 * self.bins[index][0] / self.bins[index][1] if index >= 0 else None

    def missing(self, index):
        while index >= 0 and index not in self.bins:
            index -= 1
        return self.bins[index][2] if index >= 0 else None

    def figure(self, *place):
        value = self.summary
        for key in place:
            value = value.get(key) if isinstance(value, dict) else None
        return value

    def median_fps(self):
        p50 = self.figure("frame_ms", "p50")
        return 1000 / p50 if p50 else None


def plot(title, unit, note, series, kind="line", small=False, top=0):
    """A plot for the script of reports: engine/telemetry/page.hpp."""
    data = {"title": title, "unit": unit, "kind": kind, "top": top, "zooms": True, "small": small,
            "levels": [], "series": [{"name": name, "colour": colour, "v": values}
                                     for name, colour, values in series]}
    legend = "".join(f'<span><i class="swatch{colour}"></i>{text(name)}</span>' for name, colour, _ in series)
    return (f'<figure class="plot"><figcaption>{text(title)}</figcaption><div class="legend">{legend}</div>'
            f'<div class="drawing"></div><p class="note">{text(note)}</p><script type="application/json">'
            f'{json.dumps(data).replace("<", chr(92) + "u003c")}</script></figure>\n')


def table(head, lines):
    cells = "".join(f"<td>{text(cell)}</td>" for cell in head[1:])
    rows = "".join("<tr><th>{}</th>{}</tr>".format(text(line[0]), "".join(f"<td>{text(c)}</td>" for c in line[1:]))
                   for line in lines)
    return f'<section><table><tr><th>{text(head[0])}</th>{cells}</tr>{rows}</table></section>\n'


def rounded(values):
    return [None if value is None else round(value, 3) for value in values]


def figure_8(runs, bins, quick):
    out = ["<h1 class=\"part\">Figure 8: frame rate during synthesis</h1>\n"]
    out.append("<p>The paper flew for 27 seconds and measured the frame rate on one core, on two cores, and on two with "
               "one of them off. With one core it fell from about 25 frames/s to less than 15 during synthesis; with "
               "two it did not. psygen runs modelers at the lowest priority of the operating system (ours). The "
               "second plot of each pair shows them at normal priority, for contrast.</p>\n")
    colours = {"one_core": 6, "two_cores": 3, "one_of_two": 4}
    for priority, words in (("lowest", "modelers at the lowest priority (ours)"),
                            ("normal", "modelers at normal priority")):
        for get, title, unit, kind in (
                (Run.fps, "Frame rate, " + words, "frames/s", "line"),
                (Run.missing, "Meshes missing or too coarse, " + words, "% of the pixels", "peaks")):
            series = [(name, colours[key], rounded(get(runs[f"{key}_{priority}"], i) for i in range(bins)))
                      for key, name in CONFIGURATIONS if not runs[f"{key}_{priority}"].failed]
            out.append(plot(title, unit, f"In windows of {BIN_S} s.", series, kind, kind == "peaks"))
    lines = []
    for key, name in CONFIGURATIONS:
        for priority in ("lowest", "normal"):
            run = runs[f"{key}_{priority}"]
            if run.failed:
                lines.append([f"{name}, {priority}", run.failed])
                continue
            p99 = run.figure("frame_ms", "p99")
            lines.append([f"{name}, {priority} priority", number(run.median_fps()), number(p99),
                          number(run.figure("hitches"), "{}"), number(run.figure("missing", "frames"), "{}"),
                          number(run.figure("missing", "coarse_seconds")),
                          number(run.figure("synthesis", "models"), "{:,}")])
    out.append(table(["", "frames/s, median", "p99, ms", "hitches", "frames with a hole",
                      "too coarse, s", "models made"], lines))
    one, two = runs["one_core_lowest"], runs["two_cores_lowest"]
    normal = runs["one_core_normal"]
    if not quick and not (one.failed or two.failed or normal.failed) and all(r.median_fps() for r in (one, two, normal)):
        out.append(f"<p>Measured: the median is {one.median_fps():.1f} frames/s with one core and "
                   f"{two.median_fps():.1f} with two. With modelers at normal priority one core gives "
                   f"{normal.median_fps():.1f}. A software device draws with all processors, so part of the "
                   "difference between one core and two is drawing; the paper had a graphics card.</p>\n")
    return "".join(out)


def figure_9(folder):
    out = ["<h1 class=\"part\">Figure 9: the cost of a model</h1>\n<p>Time of one core for one model, over each "
           "integer of the paper's formulas, and the fitted formula.</p>\n"]
    if (folder / "curves/failed").exists():
        return out[0] + "<p>There is no result: psygen calibrate failed.</p>\n"
    page = (folder / "curves/calibration.html").read_text(encoding="utf-8")
    names = ("terrain: time over size", "rock: time over subdivisions", "tree: time over iterations",
             "tree: time over branches")
    figures = [f for f in re.findall(r"<figure>.*?</figure>", page, re.S)
               if any(f"<figcaption>{name}" in f for name in names)]
    out.append('<div class="curves">' + "".join(figures) + "</div>\n")
    curves = json.loads((folder / "curves/calibration.json").read_text())["curves"]
    lines = [[f"{c['model']}, {c['parameter']}", c["formula"], f"{c['c_seconds'] * 1e9:.3g} ns",
              f"{c['r_squared']:.3f}", f"{c['with_fixed']['a_seconds'] * 1e6:.3g} µs",
              f"{c['with_fixed']['r_squared']:.3f}"]
             for c in curves if c["model"] in ("terrain", "rock", "tree")]
    out.append(table(["", "formula", "c", "R²", "with a fixed time a", "R²"], lines))
    return "".join(out)


def world_table(runs, folder):
    world = next((run.summary["world"] for run in runs.values() if run.summary), None)
    out = ["<h1 class=\"part\">The size of the world</h1>\n"]
    if world is None:
        return out[0] + "<p>No flight was completed.</p>\n"
    out.append(table(["", "paper", "here"], [[name, paper, get(world)] for name, paper, get in WORLD]))
    if not (folder / "world/failed").exists():
        made = json.loads((folder / "world/output.json").read_text())
        share = world["blocks"][0] * world["blocks"][1] / made["blocks"]
        out.append(f"<p>Measured: {made['blocks']} blocks with {made['triangles']:,} triangles took "
                   f"{made['cpu_seconds']:.3g} s of one core. At that rate all of it would take "
                   f"{share * made['cpu_seconds'] / 60:.3g} minutes of one core.</p>\n")
    return "".join(out)


def paradigms(runs, bins):
    out = ["<h1 class=\"part\">The three paradigms</h1>\n<p>The same flight, with two cores and a shorter view. "
           "<b>Data amplification</b> synthesises all meshes around the first pose before the first frame, and "
           "none later. <b>Lazy evaluation</b> synthesises the meshes of each frame and keeps none. "
           "<b>Parallel lazy amplification</b> synthesises in advance the meshes that will soon be visible, beside the frames, and "
           "keeps them.</p>\n"]
    flown = [(key, name) for key, name in PARADIGMS if not runs[key].failed]
    colours = {"paradigm_amplify": 5, "paradigm_lazy": 6, "paradigm_pla": 3}
    for get, title, unit, kind in ((Run.fps, "Frame rate of the three paradigms", "frames/s", "line"),
                                   (Run.missing, "Meshes missing or too coarse", "% of the pixels", "peaks")):
        out.append(plot(title, unit, f"In windows of {BIN_S} s.",
                        [(name, colours[key], rounded(get(runs[key], i) for i in range(bins)))
                         for key, name in flown], kind, kind == "peaks"))
    lines = []
    for key, name in PARADIGMS:
        run = runs[key]
        if run.failed:
            lines.append([name, run.failed])
            continue
        drawn = run.figure("synthesis", "share_drawn")
        frames = run.figure("run", "measured_frames") or 1
        models = run.figure("synthesis", "models")
        lines.append([name, number(run.figure("frame_ms", "p50")), number(run.figure("frame_ms", "p99")),
                      number(run.figure("missing", "frames"), "{}"),
                      number(run.figure("missing", "coarse_seconds")),
                      number(run.figure("cache", "peak_bytes") / 2**20, "{:.0f}"),
                      number(run.figure("memory", "peak_rss_bytes") / 2**20, "{:.0f}"),
                      number(None if models is None else models / frames),
                      number(None if drawn is None else 100 * (1 - drawn)),
                      number(run.figure("cache", "regenerations"), "{:,}")])
    out.append(table(["", "frame p50, ms", "p99, ms", "frames with a hole", "too coarse, s", "geometry, MiB",
                      "memory, MiB", "models made per frame", "never drawn, % of triangles", "made again"], lines))
    out.append("<p>Work is wasted in two ways: triangles that are never drawn, and models that are made again. Lazy "
               "evaluation makes nearly all models of a frame again in each frame (column "
               "&ldquo;models made per frame&rdquo;).</p>\n")
    return "".join(out)


def machine(folder, runs, quick):
    info = pathlib.Path("/proc/cpuinfo").read_text()
    name = re.search(r"model name\s*: (.*)", info)
    memory = int(re.search(r"MemTotal:\s*(\d+)", pathlib.Path("/proc/meminfo").read_text()).group(1))
    device = next((run.summary["device"]["name"] for run in runs.values() if run.summary), "no device")
    before = (folder / "load_before").read_text().split()[0]
    words = (f"Measured on {name.group(1) if name else 'an unknown processor'}, {os.cpu_count()} processors, "
             f"{memory / 2**20:.1f} GiB of memory, {platform.system()} {platform.release()}, drawn by {device}, "
             f"with {(folder / 'version').read_text().strip()}. The load before the first run was {before}.")
    out = f"<p class=\"lead\">{text(words)}</p>\n"
    if quick:
        out += ("<section class=\"verdict fair\"><b>A quick run on the virtual clock</b><p>Its frame times are "
                "fixed costs, the same for any number of cores. It only shows that the script works.</p></section>\n")
    elif float(before) > 0.3:
        out += ("<section class=\"verdict bad\"><b>The machine was not quiet</b><p>Other programs used it, so "
                "times are too long, and differ by chance.</p></section>\n")
    if (os.cpu_count() or 1) < 2:
        out += "<p>There is only one processor, so two cores could not be measured.</p>\n"
    return out


STYLE = """.part { font-size:20px; margin:34px 0 6px } p { max-width:76ch } main > section:not(.verdict) {
background:var(--card); border:1px solid var(--edge); border-radius:10px; padding:12px 16px; margin-top:14px;
overflow-x:auto } td { padding-left:14px } table th { white-space:normal } .curves { display:grid; gap:0 14px;
grid-template-columns:repeat(auto-fit,minmax(min(420px,100%),1fr)) } .commands { font-size:12.5px }
.commands li { overflow-wrap:anywhere; margin:4px 0 }"""


def main():
    folder, quick = pathlib.Path(sys.argv[1]), sys.argv[2] == "1"
    names = [f"{key}_{priority}" for key, _ in CONFIGURATIONS for priority in ("lowest", "normal")]
    runs = {name: Run(folder / name) for name in names + [key for key, _ in PARADIGMS]}
    report = next(folder / name / "report.html" for name, run in runs.items() if not run.failed)
    report = report.read_text(encoding="utf-8")
    style = re.search(r"<style>(.*?)</style>", report, re.S).group(1)
    script = re.findall(r"<script>(.*?)</script>", report, re.S)[-1]
    bins = 1 + max(max(run.bins, default=0) for run in runs.values())
    rows = {"t": [i * BIN_S for i in range(bins)], "n": [], "every": 1, "warmup": 1, "times": 0, "apart": {},
            "pictures": {}, "figures": [], "parts": []}
    commands = "".join(f"<li><code>{text((folder / name / 'command').read_text().strip())}</code></li>"
                       for name in [*runs, "curves", "world"])
    page = (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
        'content="width=device-width,initial-scale=1"><title>psygen: the evaluation of the paper</title>'
        f"<style>{style}{STYLE}</style></head><body><main>\n<h1>The paper's evaluation, repeated</h1>\n"
        f"{machine(folder, runs, quick)}"
        '<nav class="tools" hidden><span class="buttons"><button id="whole" disabled>Whole flight</button>'
        '<button id="out" disabled>Zoom out</button></span><span id="range" role="status"></span>'
        '<span class="hint">Drag across a plot to zoom, click for all values.</span></nav>'
        '<aside id="row" hidden></aside>'
        f'<script type="application/json" id="rows">{json.dumps(rows)}</script>\n'
        f"{figure_8(runs, bins, quick)}{figure_9(folder)}{world_table(runs, folder)}{paradigms(runs, bins)}"
        f'<h1 class="part">Commands</h1><ol class="commands">{commands}</ol></main><script>{script}</script></body></html>\n')
    (folder / "paper.html").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
