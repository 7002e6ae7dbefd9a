#!/usr/bin/env python3
"""Doxygen's input filter: turns the // comments of a public header into Doxygen's.

usage: reference_filter.py FILE

A comment belongs to the declaration below it, or to the one before it on its line. A comment that an
empty line follows belongs to nothing and stays as it is. The comment on top is the file's.
"""
import re
import sys

DIVIDER = re.compile(r"^\s*// .*-{4,}$")
ALONE = re.compile(r"^(\s*)//(?!/)\s?(.*)$")
TRAILING = re.compile(r"^(\s*\S.*?[;,{})\]\w]\s*)//(?!/)\s?(.*)$")


def converted(path, lines):
    """Returns as many lines, with Doxygen's comments."""
    out = []
    on_top, behind = True, None  # the column of the comment behind the last declaration
    for line in lines:
        alone, trailing = ALONE.match(line), TRAILING.match(line)
        if alone:
            if on_top:
                out.append(f"/// {alone[2]}")
            elif behind is not None and len(alone[1]) == behind:
                out.append(f"{alone[1]}///< {alone[2]}")
            else:
                out.append(line if DIVIDER.match(line) else f"{alone[1]}/// {alone[2]}")
            continue
        if on_top:  # most often "#pragma once", of which Doxygen has no need
            line = f"/// @file {path}"
        on_top = False
        behind = len(trailing[1]) if trailing else None
        if not line.strip():  # what stands above belongs to nothing
            for above in range(len(out) - 1, -1, -1):
                if not re.match(r"^\s*///(?!<) ", out[above]) or "@file" in out[above]:
                    break
                out[above] = out[above].replace("///", "//", 1)
        out.append(f"{trailing[1]}///< {trailing[2]}" if trailing else line)
    return out


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(converted(sys.argv[1], file.read().splitlines())))
