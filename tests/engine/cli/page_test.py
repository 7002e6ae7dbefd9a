#!/usr/bin/env python3
"""Pages in headless Chromium, without network, in wide and narrow windows: the plots of a flight's report,
zoom, values under the pointer and the panel of one frame; and the page of a comparison.

usage: page_test.py PSYGEN

Fails on any error of a script, and on any request for an external resource.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
from browser import look  # noqa: E402


def check_first_sight(page):
    for width in (1280, 400):
        seen = look(page, """
result.plots = all("figure.plot").map(f => [f.querySelector("figcaption").textContent,
  all("svg", f).length, all("path", f).filter(p => p.getAttribute("d")).length]);
result.nan = document.body.innerHTML.match(/.{0,80}N[a]N.{0,40}/g);
result.bins = all("#distribution rect").length;
result.percentiles = all("#distribution th").map(t => t.textContent);
result.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
result.slowest = all(".slowest button").length;
result.panel = panel().hidden;
result.marks = all("figure.plot")[0].querySelectorAll(".mark").length;
result.range = shown();
result.facts = all(".facts th").map(t => t.textContent + "=" + t.nextElementSibling.textContent);
""", width)
        titles = [title for title, _, _ in seen["plots"]]
        assert titles[0] == "Frame time" and titles[1].startswith("Allowed screen-space error"), titles
        for title, drawings, paths in seen["plots"]:
            assert drawings == 1, f"{title} is not drawn"
            if not title.startswith("Parts of a frame"):  # the virtual clock has no such times
                assert paths > 0, f"{title} is empty"
        assert not seen["nan"], seen["nan"]
        assert seen["bins"] > 3 and "p50" in seen["percentiles"], seen["percentiles"]
        assert seen["overflow"] <= 0, f"the page is {seen['overflow']} pixels wider than {width}"
        assert seen["slowest"] == 5 and seen["panel"], seen
        assert seen["marks"] == 0, "pictures take no time on the virtual clock"
        assert "90 frames" in seen["range"], seen["range"]
        facts = dict(fact.split("=", 1) for fact in seen["facts"])
        assert "--view-distance 300" in facts["command"], facts["command"]
        assert (facts["preset"], facts["view distance"]) == ("low", "300 m"), facts


def check_zoom(page):
    seen = look(page, """
const plots = all("figure.plot"), before = plots.map(p => all("svg", p)[0].innerHTML);
drag(plots[4], 0.5, 0.75);
result.range = shown();
result.changed = plots.filter((p, i) => all("svg", p)[0].innerHTML !== before[i]).length;
result.frames = document.querySelector("#distribution .note").textContent;
drag(plots[0], 0.2, 0.4);
result.closer = shown();
press("Zoom out");
result.out = shown();
press("Whole flight");
result.whole = shown();
result.same = plots.filter((p, i) => all("svg", p)[0].innerHTML !== before[i]).length;
""")
    frames = {name: int(re.search(r"(\d+) frames", seen[name]).group(1))
              for name in ("range", "closer", "out", "whole", "frames")}
    assert 18 <= frames["range"] <= 26, seen["range"]
    assert seen["changed"] == 8, "all plots have one zoom"
    assert 10 <= frames["closer"] < frames["range"], seen["closer"]
    assert (frames["out"], frames["whole"]) == (frames["range"], 90), seen
    assert frames["frames"] <= frames["range"], seen["frames"]
    assert seen["same"] == 0


def check_values_and_frames(page):
    seen = look(page, """
const plots = all("figure.plot");
point(plots[0], "pointermove", 0.5);
result.readout = plots[0].querySelector(".readout").textContent;
result.cursors = all(".cursor").filter(c => c.getAttribute("visibility") === "visible").length;
click(plots[0], 0.5);
result.frame = panel().textContent;
result.pins = all(".pin").length;
const key = name => document.dispatchEvent(new KeyboardEvent("keydown", {key: name}));
key("ArrowRight");
result.next = all("header b", panel())[0].textContent;
press("Nearest image: frame");
result.picture = all("header b", panel())[0].textContent;
result.apart = panel().textContent.includes("not in timing statistics");
const image = all("img", panel())[0];
await image.decode();
result.size = [image.naturalWidth, image.naturalHeight];
key("Escape");
result.closed = panel().hidden;
""")
    assert re.match(r"Frame \d+ at \d\.\d\d s", seen["readout"]) and "ms" in seen["readout"], seen
    assert seen["cursors"] == 8 and seen["pins"] == 8, seen
    number = int(re.match(r"Frame (\d+)", seen["frame"]).group(1))
    for part in ("triangles", "draws", "cache", "error", "pixels", "MiB"):
        assert part in seen["frame"], f"{part} is not in the panel: {seen['frame']}"
    assert seen["next"].startswith(f"Frame {number + 1} "), seen["next"]
    assert re.match(r"Frame (30|60) ", seen["picture"]) and not seen["apart"], seen
    assert seen["size"] == [160, 90] and seen["closed"], seen


def check_system_times(page):
    """On the wall clock: the slowest systems of a frame, separate waiting times, and excluded frames."""
    seen = look(page, """
click(all("figure.plot")[0], 0.5);
result.bars = all(".bars tr", panel()).map(r => [r.cells[0].textContent, parseFloat(r.cells[2].textContent)]);
result.stack = Math.max(...all("figure.plot").map(p => p.querySelectorAll(".stack").length));
result.marks = all("figure.plot")[0].querySelectorAll(".mark").length;
press("Nearest image: frame");
result.apart = panel().textContent.includes("not in timing statistics");
""")
    assert seen["marks"] == 1 and seen["apart"], "frames with images are marked and excluded"
    times = [ms for _, ms in seen["bars"]]
    assert times == sorted(times, reverse=True) and len(times) >= 4, seen["bars"]
    assert any(name == "visibility" for name, _ in seen["bars"]), seen["bars"]
    assert seen["stack"] >= 6, seen["stack"]


def fly(psygen, out, *options):
    """A short flight; its report."""
    subprocess.run([psygen, "fly", "--headless", "--world", "paper", "--path", "walk27", "--size",
                    "160x90", "--view-distance", "300", "--fixed-step", "30", "--frames", "90",
                    "--out", out, *options], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return out / "report.html"


def check_comparison(psygen, folder):
    """Compares a flight with one that draws less and is therefore faster."""
    sides = [folder / name for name in ("a", "b")]
    for side, error in zip(sides, ("4", "16")):
        fly(psygen, side, "--clock", "virtual", "--error", error)
    out = folder / "compared"
    done = subprocess.run([psygen, "compare", *sides, "--out", out], check=False,
                          stdout=subprocess.DEVNULL)
    assert done.returncode == 3, f"exit code {done.returncode}"
    for width in (1280, 400):
        seen = look(out / "compare.html", """
result.verdict = all(".verdict b")[0].textContent;
const plots = all("figure.plot");
result.lines = plots.map(p => all("path.line", p).filter(l => l.getAttribute("d")).length);
result.rows = all("#distribution tr").length;
result.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
click(plots[0], 0.5);
result.panel = panel().textContent;
""", width)
        assert "faster only because it draws less" in seen["verdict"], seen["verdict"]
        assert seen["lines"] == [2, 1, 2, 2], seen["lines"]
        assert seen["rows"] == 3, "percentiles of both"
        assert seen["overflow"] <= 0, f"{seen['overflow']} pixels wider than {width}"
        assert "A: Frame time" in seen["panel"] and "B / A" in seen["panel"], seen["panel"]


def main():
    with tempfile.TemporaryDirectory() as folder:
        page = fly(sys.argv[1], pathlib.Path(folder, "virtual"), "--clock", "virtual", "--images", "30")
        check_first_sight(page)
        check_zoom(page)
        check_values_and_frames(page)
        check_comparison(sys.argv[1], pathlib.Path(folder))
        check_system_times(fly(sys.argv[1], pathlib.Path(folder, "wall"), "--images", "30"))


if __name__ == "__main__":
    main()
