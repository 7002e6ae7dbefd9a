#!/usr/bin/env python3
"""Holds the lists of public headers together: every header under HEADERS of a folder's CMakeLists.txt is
there, and includes only public headers; otherwise the installed package would not compile. And each of
its functions has a comment: above it, behind it, or above the group of lines that it stands in. The game,
which is written as games outside of this project are, includes only public headers of the engine. Public
headers with GLM's types include engine/core/coordinates.hpp, which checks their layout.

usage: public_headers_test.py SOURCE_DIR
       public_headers_test.py --self-test
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)

LAYOUT = "engine/core/coordinates.hpp"
PRIVATE = re.compile(r"^ *private:.*?^(?=\};)", re.S | re.M)
GROUPS = re.compile(r"\n[ \t]*\n")
FUNCTION = re.compile(r"^\s*[\w:<>,&*\[\] ]+\s\W?\w+\([^;{]*\)[^;{()]*[;{][^\n]*$", re.M)


def without_comment(text):
    """The first lines of the groups of lines that declare a function and have no comment."""
    for group in GROUPS.split(PRIVATE.sub("", text)):
        if FUNCTION.search(group) and "//" not in group:
            yield group.strip().split("\n")[0]


def listed(folder, cmake):
    """The paths under HEADERS of one CMakeLists.txt."""
    match = re.search(r"^  HEADERS (.*?)(?=^  [A-Z_]+ |\))", cmake, re.S | re.M)
    return [f"{folder}/{name}" for name in match[1].split()] if match else []


def reached(header, text_of, found=None):
    """The headers that a header includes, and those that they include."""
    found = set() if found is None else found
    for name in INCLUDE.findall(text_of(header) or ""):
        if name not in found:
            found.add(name)
            reached(name, text_of, found)
    return found


def violations(public, text_of):
    """Violations of the public headers; text_of returns a header's text, or None."""
    for header in sorted(public):
        text = text_of(header)
        if text is None:
            yield f"{header} is listed under HEADERS, and there is no such file"
            continue
        for name in INCLUDE.findall(text):
            if name not in public and not name.startswith("../"):
                yield f"{header} is public and includes {name}, which is not under HEADERS"
        if "#include <glm/" in text and LAYOUT not in {header, *reached(header, text_of)}:
            yield f"{header} is public, has types of GLM and does not include {LAYOUT}"
        if header.startswith("engine/"):  # the rooms of ecs/ are templates with their bodies
            for line in without_comment(text):
                yield f"{header} has functions without a comment: {line}"


def beyond_the_package(public, sources):
    """Violations in the sources of a program that uses only the installed package."""
    for name, text in sorted(sources.items()):
        for header in INCLUDE.findall(text):
            if header.startswith(("engine/", "ecs/")) and header not in public:
                yield f"{name} includes {header}, which is not public"


def self_test():
    assert listed("a", "f(a\n  SOURCES x.cpp\n  HEADERS b.hpp\n          c/d.hpp\n  PUBLIC e)") == [
        "a/b.hpp", "a/c/d.hpp"]
    texts = {"a/b.hpp": '#include "a/c.hpp"\n', "a/c.hpp": "#include <span>\n"}
    assert not list(violations({"a/b.hpp", "a/c.hpp"}, texts.get))
    assert len(list(violations({"a/b.hpp"}, texts.get))) == 1
    assert len(list(violations({"a/gone.hpp"}, texts.get))) == 1
    glm = {"b.hpp": '#include "c.hpp"\n#include <glm/vec2.hpp>\n', "c.hpp": f'#include "{LAYOUT}"\n', "d.hpp": "#include <glm/vec2.hpp>\n"}
    assert [v[:5] for v in violations({*glm, LAYOUT}, {LAYOUT: "#include <glm/vec3.hpp>\n", **glm}.get)] == ["d.hpp"]
    assert len(list(beyond_the_package({"engine/a/b.hpp"}, {
        "x": '#include "engine/a/b.hpp"\n#include "game/c.hpp"\n#include "engine/a/c.hpp"\n'}))) == 1
    assert list(without_comment("// File.\n\nint f(int a);\n")) == ["int f(int a);"]
    assert list(without_comment("class A {\n  bool g() const {\n    return 1;\n  }\n};\n")) == ["class A {"]
    assert not list(without_comment("// Of f.\nint f(int a);\n\nclass A {\n private:\n  int g();\n};\n"))


def main():
    self_test()
    if sys.argv[1:] == ["--self-test"]:
        return 0
    root = pathlib.Path(sys.argv[1])
    public = set()
    for file in [root / "ecs/CMakeLists.txt", *sorted(root.glob("engine/*/CMakeLists.txt"))]:
        public.update(listed(file.parent.relative_to(root).as_posix(), file.read_text(encoding="utf-8")))
    assert len(public) > 50, "the scan found too few headers"
    texts = {name: (root / name).read_text(encoding="utf-8") for name in public if (root / name).exists()}
    game = {file.relative_to(root).as_posix(): file.read_text(encoding="utf-8") for file in root.glob("game/**/*.?pp")}
    found = [*violations(public, texts.get), *beyond_the_package(public, game)]
    print("\n".join(found) or f"public headers: {len(public)}, all complete")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
