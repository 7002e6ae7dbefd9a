#!/usr/bin/env python3
"""The day of docs/frame-tests.md: from a commit that makes a game slower to a red check, to the
commit, to the system and the function that took the time. Two builds of one game are the revisions."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

RUNS = 5  # of each revision; fewer are never judged


def run(words, expected=0, **options):
    """Runs a command and returns its output. The test ends if the exit code is another one."""
    done = subprocess.run([str(w) for w in words], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    if done.returncode != expected:
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}, expected {expected}\n"
                 f"{done.stdout}")
    return done.stdout


def expect(pattern, text, reason):
    if not re.search(pattern, text):
        sys.exit(f"{reason}: no match of {pattern!r} in\n{text}")


class Day:
    def __init__(self, psygen, fast, slow, test, folder):
        self.psygen, self.test, self.folder = psygen, test, folder
        self.game = {"fast": fast, "slow": slow}
        self.history = folder / "history.sqlite"
        self.repository = folder / "game"

    def git(self, *words):
        author = ["-c", "user.name=day", "-c", "user.email=day@example.org"]
        return run(["git", *author, *words], cwd=self.repository).strip()

    def commit(self, speed, subject):
        """A commit whose file `speed` selects the build of the game."""
        (self.repository / "speed").write_text(speed + "\n")
        (self.repository / "notes").write_text(subject + "\n")
        self.git("add", ".")
        self.git("commit", "-q", "-m", subject)
        return self.git("rev-parse", "HEAD")

    def fly(self, revision, speed, job, *options):
        """One CI job: a run of the test, and its entry in the history."""
        out = self.folder / f"{speed}_{job}"
        text = run([self.game[speed], self.test, "--out", out, *options])
        run([self.psygen, "history", "add", "--history", self.history, "--revision", revision,
             out / "walk"])
        return out, text

    def check(self, expected):
        return run([self.psygen, "history", "check", "--history", self.history], expected)

    def bisect(self, good, bad):
        # What a team's script does: build the commit, then run the test into $PSYGEN_OUT.
        script = self.folder / "build_and_fly.sh"
        script.write_text(f"""#!/bin/sh
case "$(cat speed)" in
  fast) exec {self.game["fast"]} {self.test} --out "$PSYGEN_OUT" ;;
  slow) exec {self.game["slow"]} {self.test} --out "$PSYGEN_OUT" ;;
esac
""")
        script.chmod(0o755)
        return run([self.psygen, "history", "bisect", "--history", self.history, "--test", "walk",
                    "--figure", "load.cpu_seconds", "--runs", RUNS, good, bad, "--", script],
                   cwd=self.repository)

    def live(self):
        self.repository.mkdir()
        self.git("init", "-q", "-b", "main")
        good = self.commit("fast", "Find paths")
        base, _ = self.fly(good, "fast", 0, "--profile")
        for job in range(1, RUNS):
            self.fly(good, "fast", job)
        self.commit("fast", "Write notes")
        slower = self.commit("slow", "Try all ways")
        bad = self.commit("slow", "Write more notes")
        for job in range(RUNS):
            self.fly(bad, "slow", job)

        red = self.check(expected=3)
        expect(r"load\.cpu_seconds.*worse|worse.*load\.cpu_seconds", red, "the check names no figure")
        _, text = self.fly(bad, "slow", RUNS, "--profile", "--base", base)
        expect(r"walk: against the base: 'step paths' took \d+ % of the difference", text,
               "the test names no system")
        if "perf cannot sample" not in text:
            expect(r"mostly in game::find_path", text, "the test names no function")
        found = self.bisect(good, bad)
        expect(slower + " is the first bad commit", found, "bisect finds another commit")
        print(red, text, found, sep="\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("psygen", "fast", "slow", "test"):
        parser.add_argument(name, type=lambda text: pathlib.Path(text).resolve())
    arguments = vars(parser.parse_args())
    if shutil.which("git") is None:
        sys.exit("git is missing")
    for name in ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"):
        os.environ.pop(name, None)
    os.environ["GIT_CONFIG_GLOBAL"] = os.devnull
    with tempfile.TemporaryDirectory() as folder:
        Day(**arguments, folder=pathlib.Path(folder)).live()


if __name__ == "__main__":
    main()
