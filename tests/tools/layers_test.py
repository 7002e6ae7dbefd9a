#!/usr/bin/env python3
"""Holds the layers of docs/architecture.md: scans #include lines and fails on a forbidden arrow.

usage: layers_test.py SOURCE_DIR
       layers_test.py --self-test
"""
import pathlib
import re
import sys

# folder -> folders of this project whose headers it may include (its own always)
MAY_KNOW = {
    "ecs": set(),
    "engine/core": set(),
    "engine/models": {"engine/core"},
    "engine/world": {"engine/core", "engine/models"},
    "engine/query": {"engine/core", "engine/models", "engine/world"},
    "engine/physics": {"engine/core", "engine/models", "engine/world", "engine/query"},
    "engine/synthesis": {"engine/core", "engine/models"},
    "engine/exchange": {"engine/core", "engine/image", "engine/models", "engine/world"},
    "engine/amplify": {"engine/core", "engine/models", "engine/world", "engine/synthesis",
                       "engine/exchange", "engine/telemetry"},
    "engine/cluster": {"engine/core", "engine/models", "engine/world", "engine/synthesis", "engine/exchange",
                       "engine/amplify", "engine/telemetry"},
    "engine/tiles": {"engine/core", "engine/image", "engine/models", "engine/world", "engine/synthesis", "engine/exchange",
                     "engine/amplify", "engine/telemetry"},
    "engine/visibility": {"engine/core"},
    "engine/image": {"engine/core"},
    "engine/gltf": {"engine/core", "engine/image"},
    "engine/handmade": {"engine/core", "engine/models", "engine/world", "engine/image", "engine/gltf"},
    "engine/render": {"engine/core", "engine/image", "shaders"},
    "engine/platform": {"engine/core"},
    "engine/program": {"engine/core", "engine/telemetry"},
    "engine/input": {"engine/core", "engine/platform", "engine/world"},
    "engine/telemetry": {"engine/core"},
    "engine/captures": {"engine/core"},
    "engine/compare": {"engine/core", "engine/telemetry", "engine/captures"},
    "engine/history": {"engine/core", "engine/telemetry", "engine/captures", "engine/compare", "engine/sqlite"},
    "engine/scene": {"ecs", "engine/core", "engine/models", "engine/world", "engine/query", "engine/physics",
                     "engine/synthesis",
                     "engine/visibility", "engine/image", "engine/render", "engine/platform",
                     "engine/telemetry"},
    "engine/audio": {"engine/core"},
    "engine/sqlite": {"engine/core"},
    "engine/save": {"ecs", "engine/core", "engine/models", "engine/world", "engine/sqlite"},
    "shaders": set(),
}
MAY_KNOW["engine/app"] = MAY_KNOW["engine/scene"] | {"engine/scene", "engine/amplify", "engine/exchange", "engine/handmade", "engine/input"}
MAY_KNOW["engine/frametest"] = MAY_KNOW["engine/app"] | {"engine/app", "engine/compare", "engine/program"}
MAY_KNOW["engine/inspect"] = MAY_KNOW["engine/app"] | {"engine/app"}
MAY_KNOW["engine/cli"] = MAY_KNOW["engine/app"] | {"engine/app", "engine/inspect", "engine/frametest", "engine/compare", "engine/history", "engine/cluster", "engine/program", "engine/tiles"}
MAY_KNOW["engine/prefab"] = MAY_KNOW["engine/scene"] | {"engine/scene", "engine/gltf"}
MAY_KNOW["game"] = MAY_KNOW["engine/app"] | {"engine/app", "engine/audio", "engine/program", "engine/save"}
MAY_KNOW["editor/document"] = {"engine/core", "engine/models", "engine/world", "engine/handmade", "engine/image"}
MAY_KNOW["editor/cost"] = MAY_KNOW["editor/document"] | {"engine/synthesis", "editor/document"}
MAY_KNOW["editor/view"] = MAY_KNOW["engine/app"] | {"engine/app"}
MAY_KNOW["editor/panels"] = MAY_KNOW["editor/view"] | {"editor/document", "editor/cost", "editor/view"}
MAY_KNOW["editor/tools"] = MAY_KNOW["editor/view"] | {"editor/document", "editor/view"}
MAY_KNOW["editor/attach"] = MAY_KNOW["editor/panels"] | {"engine/inspect", "editor/panels"}
MAY_KNOW["editor/flights"] = MAY_KNOW["engine/app"] | {"engine/app", "engine/compare", "editor/document", "editor/view"}
MAY_KNOW["editor/pictures"] = MAY_KNOW["engine/cli"] | {"engine/cli", "editor/document", "editor/cost"}
MAY_KNOW["editor/gallery"] = MAY_KNOW["editor/panels"] | {"editor/panels", "editor/pictures"}
MAY_KNOW["editor/shell"] = (MAY_KNOW["editor/pictures"] | MAY_KNOW["editor/gallery"] | MAY_KNOW["editor/attach"] |
                            {"editor/gallery", "editor/attach", "editor/flights", "editor/tools"})
MAY_KNOW["editor"] = MAY_KNOW["editor/shell"] | {"editor/shell", "engine/program"}

# folder inside a layer -> its neighbours that it may include. The layer's own headers, one folder up,
# may be included by all of them but those of NOT_UP.
INSIDE = {
    "engine/models/kit": set(),
    "engine/models/network": {"kit"},
    "engine/models/ground": {"network", "kit"},
    "engine/models/terrain": {"ground", "network", "kit"},
    "engine/models/tree": {"kit"},
    "engine/models/rock": {"kit"},
    "engine/models/grass": {"kit"},
    "engine/models/water": {"ground", "network", "kit"},
    "engine/world": set(),
    "engine/world/files": set(),
    "engine/world/far": set(),
    "engine/world/edits": set(),
}
NOT_UP = {"engine/models/kit"}

# layer -> (its rooms in order, its values). A room is a folder: it may include itself, the rooms
# before it, and the values, which are headers beside the rooms that include no room (file names
# without endings). All other files beside the rooms may include every room, and no room them.
ORDERED_ROOMS = {
    "engine/render": (["device", "memory", "text", "textures", "frame", "meshes", "passes"],
                      {"types", "preset", "particles", "hud_drawing"}),
    "engine/scene": (["facts", "frame", "nodes", "view", "objects", "meshes", "draws"],
                     {"components", "events", "places", "settings", "statistics", "systems"}),
}

# library header -> the only folders that may include it
ONLY_IN = {
    r"^(vulkan/|volk\.h)": {"engine/render", "engine/platform", "editor/view"},
    r"^(bt[A-Z]|Bullet|LinearMath/)": {"engine/physics"},
    r"^GLFW/": {"engine/platform"},
    r"^imgui/": {"engine/render", "engine/app", "game"},
    r"^OpenImageIO/": {"engine/image"},
    r"^toml\+\+/": {"engine/world", "game"},
    r"^nlohmann/": {"engine/gltf", "engine/telemetry", "engine/captures", "engine/compare", "engine/history", "engine/frametest", "engine/inspect", "engine/cli"},
    r"^CLI/": {"engine/cli", "engine/frametest", "engine/program", "game"},
    r"^tiny_gltf": {"engine/exchange"},
    r"^draco/": {"engine/gltf"},
    r"^meshoptimizer": {"engine/gltf", "engine/handmade", "engine/scene"},
    r"^spdlog/": {"engine/core"},
    r"^(AL/|sndfile)": {"engine/audio"},
    r"^sqlite3": {"engine/sqlite"},
    r"^mpi": {"engine/cluster"},
    r"^Q[A-Z]|^Qt": {folder for folder in MAY_KNOW if folder.startswith("editor")},
}
THREADS = re.compile(r"^(thread|mutex|condition_variable|shared_mutex|future)$")
NO_THREADS = {"ecs", "engine/models", "engine/world", "engine/query", "engine/physics", "engine/visibility",
              "engine/exchange", "engine/gltf", "engine/sqlite", "engine/save"}
BUT_HERE = {"ecs/schedule.cpp"}  # the only file of these layers that starts threads

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def folder_of(path):
    """The layer that a path relative to the root belongs to, or None."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] in ("engine", "editor") and len(parts) > 2:
        return "/".join(parts[:2])
    return parts[0] if parts[0] in MAY_KNOW else None


def room_violation(path, name):
    """The reason why a file must not include another header of its layer, or None."""
    room, target = (str(pathlib.PurePosixPath(p).parent) for p in (path, name))
    if room == target or room not in INSIDE:
        return None
    if room == str(pathlib.PurePosixPath(target).parent):
        return f"{room} must not know what is inside it"
    if target == str(pathlib.PurePosixPath(room).parent):
        return f"{room} is below it" if room in NOT_UP else None
    if target in INSIDE and folder_of(target + "/") == folder_of(room + "/"):
        neighbour = target.rsplit("/", 1)[1]
        return None if neighbour in INSIDE[room] else f"{room} must not know {target}"
    return None


# header -> the only folders that may include it
PRIVATE = {"engine/scene/state.hpp": ("engine/scene/", "tests/engine/scene/", "tests/engine/app/", "tests/bench/scene/")}


def order_violation(path, name):
    """The same for a layer with ordered rooms."""
    layer = folder_of(path)
    if layer not in ORDERED_ROOMS or folder_of(name) != layer:
        return None
    rooms, values = ORDERED_ROOMS[layer]

    def place(file):
        """The number of a file's room, -1 for values, len(rooms) for other files beside the rooms."""
        inside = pathlib.PurePosixPath(file).relative_to(layer)
        if len(inside.parts) == 1:
            return -1 if inside.stem in values else len(rooms)
        return rooms.index(inside.parts[0]) if inside.parts[0] in rooms else None

    user, used = place(path), place(name)
    if user is None or used is None:
        return f"the rooms of {layer} are {', '.join(rooms)}"
    return f"of {layer}, {rooms[user] if 0 <= user else 'a value'} may know only what is before it" if used > user else None


def violations(path, lines):
    """The forbidden includes of one file, as messages."""
    layer = folder_of(path)
    found = []
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match.group(2)
        where = f"{path}:{number}"
        target = folder_of(name)
        if target and target != layer and target not in MAY_KNOW[layer]:
            found.append(f"{where}: {layer} must not know {target} ({name})")
        if reason := room_violation(path, name):
            found.append(f"{where}: {reason} ({name})")
        if reason := order_violation(path, name):
            found.append(f"{where}: {reason} ({name})")
        if not path.startswith(PRIVATE.get(name, "")):
            found.append(f"{where}: {name} is private")
        if not target and match.group(1) == '"' and name.split("/")[0] in ("engine", "tests", "tools"):
            found.append(f"{where}: {name} is not in a layer that {layer} may know")
        for pattern, folders in ONLY_IN.items():
            if re.search(pattern, name) and layer not in folders:
                found.append(f"{where}: only {', '.join(sorted(folders))} may include {name}")
        if THREADS.match(name) and layer in NO_THREADS and path not in BUT_HERE:
            found.append(f"{where}: {layer} knows no threads ({name})")
    return found


def self_test():
    bad = {
        "engine/models/a.cpp": '#include "engine/synthesis/cache.hpp"',
        "ecs/a.hpp": '#include "engine/core/error.hpp"',
        "engine/scene/a.cpp": "#include <vulkan/vulkan.h>",
        "engine/world/a.cpp": "#include <thread>",
        "ecs/a.cpp": "#include <mutex>",
        "engine/app/a.cpp": '#include "engine/cli/commands.hpp"',
        "engine/core/a.cpp": '#include "tests/engine/core/fake.hpp"',
        "engine/models/tree/a.cpp": '#include "engine/models/rock/rock.hpp"',
        "engine/models/kit/a.cpp": '#include "engine/models/tree/tree.hpp"',
        "engine/world/a.cpp": '#include "engine/world/far/merged_models.hpp"',
        "engine/world/files/a.cpp": '#include "engine/world/far/merged_models.hpp"',
        "engine/models/kit/a.hpp": '#include "engine/models/registry.hpp"',
        "editor/document/a.hpp": '#include "engine/scene/tick.hpp"',
        "editor/document/b.hpp": '#include "editor/window/window.hpp"',
        "engine/scene/b.hpp": '#include "editor/document/document.hpp"',
        "engine/world/b.hpp": "#include <QString>",
        "engine/amplify/a.cpp": "#include <mpi.h>",
        "engine/render/memory/a.hpp": '#include "engine/render/frame/targets.hpp"',
        "engine/render/passes/a.cpp": '#include "engine/render/renderer.hpp"',
        "engine/render/types.hpp": '#include "engine/render/device/vulkan.hpp"',
        "engine/render/attic/a.cpp": '#include "engine/render/types.hpp"',
        "engine/scene/view/a.hpp": '#include "engine/scene/draws/ground.hpp"',
        "engine/scene/draws/a.cpp": '#include "engine/scene/state.hpp"',
        "engine/scene/events.hpp": '#include "engine/scene/view/view.hpp"',
        "engine/app/b.cpp": '#include "engine/scene/state.hpp"',
    }
    for path, line in bad.items():
        assert violations(path, [line]), f"not noticed: {path}: {line}"
    assert not violations("engine/world/a.cpp", ['#include "engine/models/registry.hpp"'])
    assert not violations("engine/synthesis/a.cpp", ["#include <thread>"])
    assert not violations("engine/scene/draws/a.cpp", ['#include "engine/scene/view/view.hpp"'])
    assert not violations("engine/scene/tick.cpp", ['#include "engine/scene/state.hpp"'])
    for name in ("kit/packing.hpp", "model_type.hpp", "tree/plan.hpp"):
        assert not violations("engine/models/tree/a.cpp", [f'#include "engine/models/{name}"'])
    for path, name in (("frame/a.cpp", "memory/memory.hpp"), ("frame/a.cpp", "types.hpp"),
                       ("renderer_create.cpp", "passes/sky.hpp"), ("preset.cpp", "types.hpp")):
        assert not violations(f"engine/render/{path}", [f'#include "engine/render/{name}"'])
    print("layers: the scanner notices forbidden arrows")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    found, scanned = [], 0
    for top in ("ecs", "engine", "game", "editor", "shaders"):
        for file in sorted((root / top).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".h", ".inl"):
                scanned += 1
                found += violations(file.relative_to(root).as_posix(),
                                    file.read_text(encoding="utf-8").splitlines())
    for file in sorted((root / "tests").rglob("*.?pp")):
        path = file.relative_to(root).as_posix()
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if match and not path.startswith(PRIVATE.get(match.group(2), "")):
                found.append(f"{path}:{number}: {match.group(2)} is private")
    print("\n".join(found) or f"layers: {scanned} files, no forbidden arrow")
    assert scanned > 20, "the scan found too few files"
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
