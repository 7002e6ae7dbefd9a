#!/usr/bin/env python3
"""Compares README.md and docs/ with the tree. Links have targets, and no gap is left. Options of the command line are
described; commands in the text have options, worlds, paths and scripts that exist. Files, folders and members that pages
name exist. New names of the changelog exist, and old headers do not. Labels of tests name tests. Versions agree. The
README's program is the tutorial test. Two pages have a limit of lines.

usage: docs_test.py SOURCE_DIR
       docs_test.py --installed FOLDER    only the links of all pages below the folder of installed documents
"""
import collections
import fnmatch
import functools
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


def dead_links(root, pages_of=pages):
    for page in pages_of(root):
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target, anchor in re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", prose):
            if "://" in target:
                continue
            linked = page.parent / target if target else page
            if not linked.exists():
                yield f"{page.name}: the link to {target} is dead"
            elif root.resolve() not in linked.resolve().parents:
                yield f"{page.name}: the link to {target} leaves the folder"
            elif anchor and linked.suffix == ".md" and anchor not in anchors(linked):
                yield f"{page.name}: {linked.name} has no heading #{anchor}"


TOPS = ("ecs", "engine", "editor", "game", "tests", "examples", "shaders", "docs", "tools", "cmake", ".ci", ".github")
SOURCE = re.compile(r".*\w\.(cpp|hpp|h|inl|py|sh|cmake|glsl|vert|frag|comp|md|txt|toml|css|js|yml)$")


@functools.cache
def files_of(root):
    """Files and folders of the tree, relative to the root."""
    found = [file for top in TOPS for file in (root / top).rglob("*")] + list(root.glob("*"))
    return [file.relative_to(root).as_posix() for file in found if "__pycache__" not in file.parts]


def missing_files(root):
    """Files and folders that a page names in code spans. A name without its folder may lie in any. NAME stands for
    any text. The changelog names old headers, so renamed_names() reads it."""
    seen = 0
    for page in pages(root):
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for name in set(re.findall(r"`([\w./*-]+)`", prose)) if page.name != "CHANGELOG.md" else ():
            pattern = name.rstrip("/").replace("NAME", "*")
            if SOURCE.match(name) or "/" in name and name.split("/")[0] in TOPS:
                seen += 1
                if not any(fnmatch.fnmatchcase("/" + file, "*/" + pattern) for file in files_of(root)):
                    yield f"{page.relative_to(root)}: there is no {name}"
    assert seen > 100, "the scan found too few names of files"


def code_of(root, header):
    return re.sub(r"//[^\n]*|^\s*#[^\n]*", "", (root / header).read_text(encoding="utf-8"), flags=re.M)


def renamed_names(root):
    """Rows of the changelog's tables: each new name stands in the code of a header of its row."""
    text = (root / "CHANGELOG.md").read_text(encoding="utf-8").split("\n## Names\n")[1]
    rows = [[re.findall(r"`([^`]+)`", cell) for cell in row.strip("|").split("|")]
            for row in re.findall(r"^\|.*`.*\|$", text, re.M)]
    assert len(rows) > 20, "the scan found too few rows"
    for row in rows:
        if len(row) == 2:
            (old,), (new,) = row
            if (root / old).exists():
                yield f"CHANGELOG.md: the old header {old} exists"
            if not (root / new).exists():
                yield f"CHANGELOG.md: there is no header {new}"
            continue
        _, names, headers = row
        lost = [header for header in headers if not (root / header).exists()]
        yield from (f"CHANGELOG.md: there is no header {header}" for header in lost)
        code = "" if lost else "\n".join(code_of(root, header) for header in headers)
        for name in names if code else ():
            for word in re.findall(r"\w+", name.split("(")[0])[-2 if "::" in name else -1:]:
                if not re.search(rf"\b{word}\b", code):
                    yield f"CHANGELOG.md: {word} of {name} is not in {' or '.join(headers)}"


def missing_names(root):
    """Names such as Scene::tick in code spans: a file that declares the scope has the member."""
    members = collections.defaultdict(set)  # scope -> words of the files that declare it
    for file in files_of(root):
        if file.endswith((".hpp", ".cpp")) and file.split("/")[0] in ("ecs", "engine", "editor", "game", "examples"):
            text = code_of(root, file)
            scopes = re.findall(r"\b(?:enum class|class|struct|enum)\s+(?:alignas\([^)]*\)\s*)?(\w+)|\bnamespace\s+([\w:]+)|\busing\s+(\w+)\s*=", text)
            for scope in {part for names in scopes for name in names for part in name.split("::") if part}:
                members[scope].update(re.findall(r"\w+", text))
    assert len(members) > 1000, "the scan found too few types"
    for page in pages(root):
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for name in set(re.findall(r"`((?:\w+::)+\w+)", prose)) if page.name != "CHANGELOG.md" else ():
            *_, scope, last = name.split("::")
            # Names of other libraries, and of targets of CMake.
            if not name.startswith(("std::", "ImGui::", "Vulkan::")) and scope != "psygen" and last not in members[scope]:
                yield f"{page.relative_to(root)}: there is no {name}"


def missing_tests(root):
    """Names of tests such as Suite.IsASentence in pages, also by their beginning with … or *."""
    text = "".join(file.read_text(encoding="utf-8") for suffix in ("*.cpp", "*.hpp") for file in (root / "tests").rglob(suffix))
    tests = [".".join(name) for name in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)", text, re.M)]
    for page in pages(root):
        for name in set(re.findall(r"\b([A-Z]\w+\.[A-Z]\w*[a-z]\w*)(?=[…*`'])", page.read_text(encoding="utf-8"))):
            if not any(test.startswith(name) for test in tests):
                yield f"{page.relative_to(root)}: there is no test {name}"


def long_pages(root):
    notes = (root / "CHANGELOG.md").read_text(encoding="utf-8").split("\n## Names\n")[0]
    performance = (root / "docs/performance.md").read_text(encoding="utf-8")
    for what, text, limit in (("CHANGELOG.md: the notes of the release", notes, 80),
                              ("docs/performance.md", performance, 250)):
        if text.count("\n") > limit:
            yield f"{what}: {text.count(chr(10))} lines, and the limit is {limit}"


def repeated_headings(root):
    for page in pages(root):
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        headings = collections.Counter(re.findall(r"^#+ .*$", text, re.M))
        yield from (f"{page.relative_to(root)}: '{line}' occurs {count} times"
                    for line, count in headings.items() if count > 1)


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


# Commands whose options are declared elsewhere, too: games have those of frame tests.
DECLARED = {"test": ["engine/frametest/run.cpp"]}


def undescribed_options(root):
    described = (root / "docs/cli.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## psygen (\w+)\n(.*?)(?=^## |\Z)", described, re.S | re.M))
    sources = sorted((root / "engine/cli").glob("*_command.cpp"))
    assert len(sources) > 2, "the scan found too few commands"
    for source in sources:
        command = source.name.removesuffix("_command.cpp")
        files = [source, *(root / other for other in DECLARED.get(command, []))]
        options = re.findall(r'"!?(--[a-z-]+)"', "".join(file.read_text(encoding="utf-8") for file in files))
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
    seen = 0
    for cmake in sorted((root / "tests").rglob("CMakeLists.txt")):
        text = re.sub(r"#[^\n]*", "", cmake.read_text(encoding="utf-8"))
        lists = re.findall(r"list\(APPEND (\w+) ([^)]*)\)", text)
        names = [".".join(name) for source in cmake.parent.rglob("*.cpp")
                 for name in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)", source.read_text(encoding="utf-8"), re.M)]
        # Calls of functions have no brackets inside: generator expressions do not stand in lists of filters.
        for filters in re.findall(r"\bNOT_[AT]SAN\s+([^()]*?)(?=\s+[A-Z_]{4,}\s|\s*\))", text):
            for variable, items in lists:  # each item of a list, whose numbers are variables
                filters = re.sub(rf"\$\{{{variable}\}}", lambda _: items + f" ${{{variable}}}", filters)
            for pattern in re.sub(r"\$\{(?:%s)\}" % "|".join(v for v, _ in lists), "", filters).split():
                seen += 1
                instance = re.fullmatch(r"\w+/(\w+\.\w+)/(?:\w+|\*|\$\{\w+\})", pattern)
                pattern = instance[1] if instance else pattern
                if not any(re.fullmatch(pattern.replace(".", r"\.").replace("*", ".*"), name) for name in names):
                    yield f"{cmake.relative_to(root)}: {pattern} selects no test"
    assert seen > 20, "the scan found too few filters"


def other_versions(root):
    """Places that name another version than project() of CMakeLists.txt."""
    version = re.search(r"project\(psygen VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    for page, pattern in (("CITATION.cff", r"^version: ([\d.]+)"), ("CHANGELOG.md", r"^## ([\d.]+)")):
        found = re.search(pattern, (root / page).read_text(encoding="utf-8"), re.M)
        if not found or found[1] != version:
            yield f"{page} names version {found and found[1]} instead of {version}"


def main():
    if sys.argv[1] == "--installed":
        installed = sorted(pathlib.Path(sys.argv[2]).rglob("*.md"))
        assert len(installed) > 20, "the scan found too few pages"
        found = list(dead_links(pathlib.Path(sys.argv[2]), lambda _: installed))
        print("\n".join(found) or "docs: no installed link is dead")
        return 1 if found else 0
    root = pathlib.Path(sys.argv[1])
    found = [*dead_links(root), *missing_files(root), *missing_names(root), *missing_tests(root), *renamed_names(root),
             *repeated_headings(root), *long_pages(root), *gaps(root), *program_differences(root),
             *undescribed_options(root), *wrong_commands(root), *stray_labels(root), *other_versions(root)]
    print("\n".join(found) or "docs: nothing missing")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
