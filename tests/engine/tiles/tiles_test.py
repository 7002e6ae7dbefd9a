#!/usr/bin/env python3
"""Exports a region as 3D Tiles and lets programs read it that know nothing of psygen: the same tiles, the same
triangles, and nothing that a validator complains about. Installs them with npm into the build folder, once.

usage: tiles_test.py PSYGEN WORK_FOLDER
Exit code 77: npm is missing or reaches no registry.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
WORLD = """format = 1
[world]
name = "tiles"
seed = 5
blocks = [7, 4]
cell_m = 2
block_vertices = 33
[terrain]
octaves = 4
relief_m = 60
[[scatter]]
model = "tree"
count = 3
iterations = [2, 3]
[[scatter]]
model = "rock"
count = 5
subdivisions = 1
"""


def install(folder):
    """True if the packages in package.json are installed."""
    wanted = (HERE / "package.json").read_text(encoding="utf-8")
    done = folder / "installed.json"
    if done.exists() and done.read_text(encoding="utf-8") == wanted:
        return True
    if not shutil.which("npm") or not shutil.which("node"):
        print("skipped: there is no npm (Debian: nodejs, npm), so nothing independent reads the tileset")
        return False
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(HERE / "package.json", folder)
    npm = subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--loglevel=error", "--fetch-retries=1",
                          "--fetch-timeout=60000"], cwd=folder, capture_output=True, text=True, timeout=400)
    if npm.returncode != 0:
        print("skipped: npm cannot install what reads tilesets:\n" + npm.stderr[-800:])
        return False
    done.write_text(wanted, encoding="utf-8")
    return True


def check(psygen, modules, folder, options, levels):
    """Exports the world with these options, and compares what psygen says with what is read."""
    out = folder / f"tiles{len(options)}"
    made = subprocess.run([psygen, "export", "--world", folder / "tiles.toml", "--region", "0,0,7,4", "--out", out, *options],
                          check=True, capture_output=True, text=True)
    said = re.search(r"(\d+) tiles in (\d+) levels, (\d+) triangles", made.stderr)
    node = subprocess.run(["node", HERE / "read_tileset.mjs", modules, out], capture_output=True, text=True)
    assert node.returncode == 0, node.stderr
    read = json.loads(node.stdout)
    print(f"{said.group(0)}; read: {node.stdout.strip()}")
    assert not read["issues"], read["issues"]
    assert read["contents"] == int(said.group(1)), "other tiles are found than were written"
    assert read["triangles"] == int(said.group(3)), "other triangles are found than were written"
    assert int(said.group(2)) == levels
    errors = [read["errors"][depth] for depth in sorted(read["errors"], key=int)]
    assert all(fine * 2 == coarse for coarse, fine in zip(errors, errors[1:])), errors


def main():
    psygen, modules = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not install(modules):
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "tiles.toml").write_text(WORLD, encoding="utf-8")
        check(psygen, modules, folder, [], 4)
        check(psygen, modules, folder, ["--levels", "1-2"], 3)
    return 0


if __name__ == "__main__":
    sys.exit(main())
