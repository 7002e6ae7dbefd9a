#!/usr/bin/env python3
"""Prints values of a program with tools/gdb/psygen.py, by gdb in batch mode. Skipped where there is no gdb, or where a
program may not be traced.

usage: gdb_test.py SOURCE_DIR PROGRAM
"""
import pathlib
import shutil
import subprocess
import sys

EXPECTED = {
    "handles": "span of 2 = {entity 0 (generation 1), entity 1 (generation 1)}",
    "nothing": "null entity",
    "position": "block (3, -4) + (1.5, 2, 0.25) m",
    "position.block": "block (3, -4)",
    "key": "block (-7, 8), index 5, type 2, LOD 1, parameters 0x00000000000000ab",
    "duplicate": "block (-7, 8), index 5, type 2, LOD 1, parameters 0x00000000000000ab (duplicate)",
    "found": "result = {value = 42}",
    "lost": "error kIo: a.toml: cannot be read",
    "done": "result without a value",
    "some": "span of 2 = {1, 2}",
    "three": "span of 3 = {1, 2, 3}",
    "rows": "2 rows from 0 of table 1 with Speed = {entity 0 (generation 1), entity 1 (generation 1)}",
}


def main():
    source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    if shutil.which("gdb") is None:
        print("gdb: there is no gdb")
        return 77
    # Without auto-load, so that the printers of libstdc++ do not take the spans.
    commands = ["set auto-load no", "set confirm off", "set width 0", f"source {source}/tools/gdb/psygen.py",
                "break stop", "run", "up"]
    commands += [f'printf "%s: ", "{name}"\noutput {name}\necho \\n' for name in EXPECTED if name != "rows"]
    commands += ['printf "%s: ", "rows"', "output rows", "echo \\n", "kill"]
    script = pathlib.Path(program + ".gdb")
    script.write_text("\n".join(commands) + "\n", encoding="utf-8")
    run = subprocess.run(["gdb", "-nx", "-batch", "-x", script, program], capture_output=True, text=True, timeout=300)
    if "ptrace: Operation not permitted" in run.stderr or "Couldn't get registers" in run.stderr:
        print("gdb: programs may not be traced here")
        return 77
    printed = dict(line.split(": ", 1) for line in run.stdout.splitlines() if ": " in line)
    wrong = [f"{name}: '{printed.get(name)}' instead of '{text}'" for name, text in EXPECTED.items()
             if printed.get(name) != text]
    print("\n".join(wrong) or "gdb: all values are printed")
    if wrong:
        print(run.stdout, run.stderr, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
