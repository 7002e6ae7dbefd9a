#!/usr/bin/env python3
"""Holds README.md and docs/ together with the tree: links lead somewhere, nothing is left to be filled
in, options of the command line are described, and the README's program is the tutorial test.

usage: docs_test.py SOURCE_DIR
"""
import pathlib
import re
import sys


def pages(root):
    return [root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md", *sorted((root / "docs").glob("*.md"))]


def dead_links(root):
    for page in pages(root):
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", prose):
            if "://" not in target and not (page.parent / target).exists():
                yield f"{page.name}: the link to {target} is dead"


def gaps(root):
    for page in pages(root):
        for gap in re.findall(r"@[A-Z_]+@|TODO|TBD", page.read_text(encoding="utf-8")):
            yield f"{page.name}: {gap} is left to be filled in"


# page -> the files of which its C++ is made
PROGRAMS = {
    "README.md": ["tests/engine/app/tutorial_test.cpp"],
    "docs/add-a-model.md": ["tests/engine/app/fence.hpp", "tests/engine/app/add_a_model_test.cpp"],
}


def program_differences(root):
    for page, sources in PROGRAMS.items():
        test = "".join((root / source).read_text(encoding="utf-8") for source in sources)
        test = re.sub(r'source_file\(("[^"]*")\)', r'\1', test)
        programs = re.findall(r"```cpp\n(.*?)```", (root / page).read_text(encoding="utf-8"), re.S)
        lines = [re.sub(r"\s*//.*", "", line).strip().rstrip(";")
                 for program in programs for line in program.splitlines()]
        assert len(lines) > 8, f"{page} shows no program"
        for line in lines:
            if line not in test:
                yield f"{page}: '{line}' is not in {' or '.join(sources)}"


def undescribed_options(root):
    described = (root / "docs/cli.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## psygen (\w+)\n(.*?)(?=^## |\Z)", described, re.S | re.M))
    sources = sorted((root / "engine/cli").glob("*_command.cpp"))
    assert len(sources) > 2, "the scan found too few commands to mean anything"
    for source in sources:
        command = source.name.removesuffix("_command.cpp")
        options = re.findall(r'"!?(--[a-z-]+)"', source.read_text(encoding="utf-8"))
        assert options, f"the scan found no option of {command}"
        for option in options:
            if f"`{option}" not in sections.get(command, ""):
                yield f"docs/cli.md does not describe {option} of psygen {command}"


def main():
    root = pathlib.Path(sys.argv[1])
    found = [*dead_links(root), *gaps(root), *program_differences(root), *undescribed_options(root)]
    print("\n".join(found) or "docs: nothing missing")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
