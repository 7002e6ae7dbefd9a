#!/usr/bin/env python3
"""Runs steps of a workflow's file as GitHub does: each `run` with bash, in one folder, until one fails.
Knows the subset of YAML that examples/template uses: steps at one indentation, `run:` in one line or as a block.

usage: workflow_steps.py FILE STEP...     the names of steps, in the order of the file
"""
import os
import pathlib
import re
import subprocess
import sys
import textwrap


def steps_of(text):
    """Commands of the steps by name, in the order of the file."""
    steps = {}
    for step in re.split(r"^      - ", text.split("    steps:\n", 1)[1], flags=re.M)[1:]:
        name = re.search(r"^(?:        )?name: (.*)$", step, re.M)
        block = re.search(r"^        run: \|\n((?:          .*\n|\n)*)", step, re.M)
        line = re.search(r"^        run: ([^|].*)$", step, re.M)
        if name and (block or line):
            steps[name[1]] = textwrap.dedent(block[1]) if block else line[1] + "\n"
    return steps


def main(file, names):
    text = pathlib.Path(file).read_text(encoding="utf-8")
    steps = steps_of(text)
    unknown = [name for name in names if name not in steps]
    if unknown:
        sys.exit(f"{file} has no step {unknown}; it has {list(steps)}")
    if [name for name in steps if name in names] != names:
        sys.exit(f"{file} has the steps in another order: {list(steps)}")
    for name in names:
        print(f"== {name}", flush=True)
        # GitHub's default shell of a step in a container.
        code = subprocess.run(["bash", "-e", "-c", steps[name]], env=os.environ, check=False).returncode
        if code != 0:
            sys.exit(code)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
