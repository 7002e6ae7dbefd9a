#!/usr/bin/env python3
"""tools/reproduce_paper.sh --quick from its first flight to its page in a browser.

usage: reproduction_test.py SOURCE_DIR PSYGEN

Fails when a run fails, when a part of the page is missing, or on an error of its script.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

from browser import look


def main():
    source, psygen = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "paper")
        subprocess.run([source / "tools/reproduce_paper.sh", "--quick", out], check=True,
                       env=dict(os.environ, PSYGEN=psygen), stdout=subprocess.DEVNULL)
        failed = [file.parent.name for file in out.glob("*/failed")]
        assert not failed, f"these runs failed: {failed}"
        for width in (1280, 400):
            seen = look(out / "paper.html", """
result.parts = all(".part").map(h => h.textContent);
result.plots = all("figure.plot").map(f => [f.querySelector("figcaption").textContent,
  all("path.line", f).filter(p => p.getAttribute("d")).length]);
result.curves = all(".curves figure").length;
result.text = document.body.innerText;
result.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
click(all("figure.plot")[0], 0.5);
result.panel = panel().textContent;
""", width)
            starts = [part.split(":")[0] for part in seen["parts"]]
            assert starts == ["Figure 8", "Figure 9", "The size of the world", "The three paradigms",
                              "Commands"], starts
            assert [lines for _, lines in seen["plots"]] == [3] * 6, seen["plots"]
            assert seen["curves"] == 4, seen["curves"]
            assert seen["overflow"] <= 0, f"{seen['overflow']} pixels wider than {width}"
            for words in ("virtual clock", "33,066,826,752", "8.47 TB", "--paradigm lazy", "Measured on"):
                assert words in seen["text"], f"'{words}' is not on the page"
            # The commands name folders, and a temporary folder's random name may contain "nan".
            text = seen["text"].replace(str(out), "").replace(psygen, "").replace(str(source), "")
            assert "nan" not in text.lower().replace("dominant", ""), "a figure is no number"
            assert "one core: Frame rate" in seen["panel"] and "frames/s" in seen["panel"], seen["panel"]


if __name__ == "__main__":
    main()
