#!/usr/bin/env python3
"""Compares README.md and docs/ with the tree. Links have targets, and no gap is left. Options of the command line are
described; commands in the text have options, worlds, paths and scripts that exist. Labels of tests name tests.
Versions agree. The README's program is the tutorial test.

usage: docs_test.py SOURCE_DIR
"""
import pathlib
import re
import sys


def pages(root):
    return [root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md", root / "ecs/README.md",
            *sorted((root / "docs").rglob("*.md"))]


def anchors(page):
    """The anchors of a page: its headings as GitHub writes them."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead_links(root):
    for page in pages(root):
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target, anchor in re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", prose):
            if "://" in target:
                continue
            linked = page.parent / target if target else page
            if not linked.exists():
                yield f"{page.name}: the link to {target} is dead"
            elif anchor and linked.suffix == ".md" and anchor not in anchors(linked):
                yield f"{page.name}: {linked.name} has no heading #{anchor}"


def gaps(root):
    for page in pages(root):
        for gap in re.findall(r"@[A-Z_]+@|TODO|TBD", page.read_text(encoding="utf-8")):
            yield f"{page.name}: {gap} is left"


# page -> the files that contain its C++
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
    assert len(sources) > 2, "the scan found too few commands"
    for source in sources:
        command = source.name.removesuffix("_command.cpp")
        options = re.findall(r'"!?(--[a-z-]+)"', source.read_text(encoding="utf-8"))
        assert options, f"the scan found no option of {command}"
        for option in options:
            if f"`{option}" not in sections.get(command, ""):
                yield f"docs/cli.md does not describe {option} of psygen {command}"


def options_of(root, command):
    sources = [root / f"engine/cli/{command}_command.cpp"]
    if command in ("fly", "picture"):
        sources.append(root / "engine/cli/scene_options.cpp")
    text = "".join(source.read_text(encoding="utf-8") for source in sources)
    return set(re.findall(r'"!?(--[a-z-]+)[",]', text)) | {"--help"}


def commands(text):
    """Command lines in shell blocks, without comments."""
    for block in re.findall(r"```sh\n(.*?)```", text, re.S):
        for line in block.replace("\\\n", " ").splitlines():
            yield re.sub(r"\s#.*", "", line)


def wrong_commands(root):
    seen = 0
    for page in pages(root):
        for line in commands(page.read_text(encoding="utf-8")):
            for command, rest in re.findall(r"\bpsygen (fly|picture|amplify|merge|export|calibrate|schedule|models)\b([^|;&]*)", line):
                seen += 1
                for option in re.findall(r"(?<=\s)--[a-z-]+", rest):
                    if option not in options_of(root, command):
                        yield f"{page.name}: psygen {command} has no option {option}"
                for kind, name in re.findall(r"--(world|path) ([\w/.-]+)", rest):
                    if name.startswith(("out/", "game/worlds/WORLD", "game/paths/PATH")):
                        continue  # stands for others, or was made by a command above
                    if not (root / name).exists() and not (root / f"game/{kind}s/{name}.toml").exists():
                        yield f"{page.name}: there is no {kind} {name}"
            for script in re.findall(r"(?<!\S)(?:tools|\.ci)/[\w.]+", line):
                if not (root / script).exists():
                    yield f"{page.name}: there is no {script}"
    assert seen > 10, "the scan found too few commands"


def stray_labels(root):
    """Filters of NOT_ASAN and NOT_TSAN (tests/CMakeLists.txt) that select no test of their folder."""
    for cmake in sorted((root / "tests").rglob("CMakeLists.txt")):
        text = re.sub(r"#[^\n]*", "", cmake.read_text(encoding="utf-8"))
        names = [".".join(name) for source in cmake.parent.rglob("*.cpp")
                 for name in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)", source.read_text(encoding="utf-8"), re.M)]
        for filters in re.findall(r"\bNOT_[AT]SAN\s+((?:[\w/*]+\.[\w/*]*\s+)+)", text):
            for pattern in filters.split():
                if not any(re.fullmatch(pattern.replace(".", r"\.").replace("*", ".*"), name) for name in names):
                    yield f"{cmake.relative_to(root)}: {pattern} selects no test"


def other_versions(root):
    """Places that name another version than project() of CMakeLists.txt."""
    version = re.search(r"project\(psygen VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    for page, pattern in (("CITATION.cff", r"^version: ([\d.]+)"), ("CHANGELOG.md", r"^## ([\d.]+)")):
        found = re.search(pattern, (root / page).read_text(encoding="utf-8"), re.M)
        if not found or found[1] != version:
            yield f"{page} names version {found and found[1]} instead of {version}"


def main():
    root = pathlib.Path(sys.argv[1])
    found = [*dead_links(root), *gaps(root), *program_differences(root), *undescribed_options(root),
             *wrong_commands(root), *stray_labels(root),
             *other_versions(root)]
    print("\n".join(found) or "docs: nothing missing")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
