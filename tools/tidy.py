#!/usr/bin/env python3
"""Runs clang-tidy on the lines that differ from a base: on changed sources, and for a changed header on a source that
includes it. Prints the findings and fails if there are any. Passes if there is no base.

usage: tools/tidy.py [BASE] [--minutes N]     BASE: a commit; default: $PSYGEN_BASE

Files that N minutes (default 10) do not suffice for are named and left out. The check easily-swappable-parameters
reports three or more parameters of a kind, and two bools.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/tidy"
FOLDERS = ("ecs", "engine", "editor", "game")
SWAPPABLE = re.compile(r"(\d+) adjacent parameters of '.*' of (?:similar|convertible) type(?: \('(.*)'\))?")


def git(*arguments):
    run = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    return run.stdout if run.returncode == 0 else None


def base_commit(name):
    """The commit in which HEAD and the base part, or None if the base does not exist here."""
    for candidate in (name, os.environ.get("PSYGEN_BASE")):
        if candidate and set(candidate) != {"0"}:  # a hosted push of a new branch has a base of zeros
            merge_base = git("merge-base", candidate, "HEAD")
            return merge_base.strip() if merge_base else None
    return None


def changed_lines(diff):
    """file -> ranges of lines that a diff without context adds or changes."""
    found, name = {}, None
    for line in diff.splitlines():
        if match := re.match(r"\+\+\+ b/(.*)", line):
            name = match[1]
        elif match := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line):
            count = int(match[2] or 1)
            if count and name and name.split("/")[0] in FOLDERS and name.endswith((".cpp", ".hpp")):
                found.setdefault(name, []).append([int(match[1]), int(match[1]) + count - 1])
    return found


def sources_of(changed, sources):
    """Each changed source, and for each changed header the source beside it or the first that includes it."""
    chosen = [name for name in changed if name in sources]
    for name in changed:
        beside = name.removesuffix(".hpp") + ".cpp"
        if name in sources:
            continue
        if beside in sources:
            chosen.append(beside)
            continue
        including = (source for source, text in sources.items() if f'"{name}"' in text)
        if source := next(including, None):
            chosen.append(source)
    return sorted(set(chosen))


def is_reported(line):
    """False for two parameters of a kind that is not bool."""
    match = SWAPPABLE.search(line)
    return not match or int(match[1]) > 2 or match[2] in ("bool", "const bool")


def findings(output):
    """The findings of one run, with the lines that belong to each."""
    blocks = re.split(r"(?m)^(?=\S+:\d+:\d+: (?:warning|error): )", output)
    return [block.rstrip() for block in blocks if re.match(r"\S+:\d+:\d+: (?:warning|error): ", block) and
            is_reported(block.split("\n")[0])]


def tidy(source, line_filter, config, until):
    left = until - time.monotonic()
    if left < 5:
        return source, None
    try:
        run = subprocess.run(["clang-tidy", "-p", str(BUILD), "--quiet", f"--config-file={config}",
                              f"--line-filter={line_filter}", source], cwd=ROOT, capture_output=True, text=True, timeout=left)
    except subprocess.TimeoutExpired:
        return source, None
    return source, findings(run.stdout) or failure(source, run)


def failure(source, run):
    """A run that failed without a finding: no compile command, a wrong option, a crash."""
    if run.returncode == 0:
        return []
    return [f"{source}: clang-tidy failed with code {run.returncode}\n{run.stderr.strip() or run.stdout.strip()}"]


def self_test():
    diff = "+++ b/engine/a.cpp\n@@ -1 +1,2 @@\n@@ -5,2 +7,0 @@\n+++ b/docs/a.md\n@@ -1 +1 @@\n"
    assert changed_lines(diff) == {"engine/a.cpp": [[1, 2]]}
    sources = {"engine/a.cpp": "", "engine/b.cpp": '#include "engine/c.hpp"'}
    assert sources_of({"engine/a.hpp": [], "engine/c.hpp": [], "engine/d.hpp": []}, sources) == ["engine/a.cpp", "engine/b.cpp"]
    two = "a.cpp:1:1: warning: 2 adjacent parameters of 'f' of similar type ('{}') are easily swapped by mistake [x]\n  int f"
    assert findings(two.format("int")) == [] and len(findings(two.format("bool"))) == 1
    assert len(findings(two.replace("2 adjacent", "3 adjacent").format("int"))) == 1
    broken = subprocess.CompletedProcess([], 1, "", "error: no such file")
    assert failure("a.cpp", broken) == ["a.cpp: clang-tidy failed with code 1\nerror: no such file"]
    assert failure("a.cpp", subprocess.CompletedProcess([], 0, "", "12 warnings generated.")) == []
    print("tidy: findings and lines are read as they should be")


def main():
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        return self_test()
    minutes = 10.0
    if "--minutes" in arguments:
        k = arguments.index("--minutes")
        minutes = float(arguments[k + 1])
        del arguments[k:k + 2]
    base = base_commit(arguments[0] if arguments else None)
    if base is None:
        print("tidy: there is no base to compare with; nothing is checked")
        return 0
    changed = changed_lines(git("diff", "-U0", "--no-ext-diff", base, "--") or "")
    tracked = [name for name in (git("ls-files", *FOLDERS) or "").splitlines()
               if name.endswith(".cpp") and not name.endswith("_windows.cpp")]  # no headers of Windows are here
    sources = {name: (ROOT / name).read_text(encoding="utf-8") for name in tracked if (ROOT / name).exists()}
    chosen = sources_of(changed, sources)
    if not chosen:
        print("tidy: no C++ has changed")
        return 0
    until = time.monotonic() + 60 * minutes
    # Without unity builds, so that each source has its own command.
    subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DPSYGEN_TESTS=OFF",
                    "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"], check=True, stdout=subprocess.DEVNULL)
    config = BUILD / "clang-tidy"
    config.write_text((ROOT / ".clang-tidy").read_text(encoding="utf-8").replace(
        "MinimumLength, value: 3", "MinimumLength, value: 2"), encoding="utf-8")
    line_filter = json.dumps([{"name": name, "lines": lines} for name, lines in changed.items()])
    found, late = [], []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, result in pool.map(lambda name: tidy(name, line_filter, config, until), chosen):
            late += [source] if result is None else []
            found += result or []
    print("\n".join(dict.fromkeys(found)) or f"tidy: {len(chosen) - len(late)} files, no finding")
    if late:
        print(f"tidy: no time was left for {len(late)} of {len(chosen)} files: {' '.join(late)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
