#!/usr/bin/env python3
"""Makes windmill.glb: a tower of bricks with a normal map, a lamp that glows, a door and four sails.

usage: make_windmill.py windmill.glb
Nodes: mill > tower, roof, lamp, door, sails > sail_0 … sail_3. Animations: "turn" (sails, 8 s, to be
repeated), "open" (door, 2 s). Metres; the mill stands on (0, 0, 0) and looks towards +Z.
"""
import json
import math
import struct
import sys
import zlib


class File:
    """A .glb in the making: JSON, and one buffer."""

    def __init__(self):
        self.binary = b""
        self.json = {"asset": {"version": "2.0", "generator": "psygen, make_windmill.py"}, "scene": 0,
                     "scenes": [{"nodes": [0]}], "extensionsUsed": ["KHR_materials_emissive_strength"],
                     "samplers": [{"magFilter": 9729, "minFilter": 9987}]}

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def view(self, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        self.binary += data
        return self.add("bufferViews", view)

    def accessor(self, rows, kind, bounds=False):
        rows = [row if isinstance(row, tuple) else (row,) for row in rows]
        whole = kind == "SCALAR" and isinstance(rows[0][0], int)
        data = b"".join(struct.pack("<%d%s" % (len(row), "H" if whole else "f"), *row) for row in rows)
        accessor = {"bufferView": self.view(data), "componentType": 5123 if whole else 5126,
                    "count": len(rows), "type": kind}
        if bounds:
            accessor["min"] = [struct.unpack("<f", struct.pack("<f", min(c)))[0] for c in zip(*rows)]
            accessor["max"] = [struct.unpack("<f", struct.pack("<f", max(c)))[0] for c in zip(*rows)]
        return self.add("accessors", accessor)

    def texture(self, name, size, pixel):
        rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(size))
        def chunk(kind, data):
            return (struct.pack(">I", len(data)) + kind + data +
                    struct.pack(">I", zlib.crc32(kind + data)))
        png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0)) +
               chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(png)})
        return {"index": self.add("textures", {"source": image, "sampler": 0})}

    def mesh(self, name, quads, material):
        """Quads: four corners, counter-clockwise from outside, and four places in the texture."""
        positions, normals, uvs, indices = [], [], [], []
        for corners, places in quads:
            u = [b - a for a, b in zip(corners[0], corners[1])]
            v = [b - a for a, b in zip(corners[1], corners[2])]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.sqrt(sum(c * c for c in n))
            first = len(positions)
            positions += [tuple(corner) for corner in corners]
            normals += [tuple(c / length for c in n)] * 4
            uvs += places
            indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
        return self.add("meshes", {"name": name, "primitives": [{
            "attributes": {"POSITION": self.accessor(positions, "VEC3", True),
                           "NORMAL": self.accessor(normals, "VEC3"),
                           "TEXCOORD_0": self.accessor(uvs, "VEC2")},
            "indices": self.accessor(indices, "SCALAR"), "material": material}]})

    def animation(self, name, node, times, turns):
        self.add("animations", {"name": name, "channels": [
            {"sampler": 0, "target": {"node": node, "path": "rotation"}}], "samplers": [
            {"input": self.accessor([float(t) for t in times], "SCALAR", True),
             "output": self.accessor(turns, "VEC4"), "interpolation": "LINEAR"}]})

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


SIZE = 128


def noise(x, y):
    return zlib.crc32(bytes((x % 256, y % 256))) % 100 / 100


def brick(x, y):
    """Height of the wall, and a number for each brick: eight rows of four."""
    row = y // 16
    across = (x + (16 if row % 2 else 0)) % SIZE
    edge = min(across % 32, 31 - across % 32, y % 16, 15 - y % 16)
    return min(edge / 2, 1), row * 4 + across // 32


def wall(x, y):
    height, number = brick(x, y)
    shade = 0.75 + 0.25 * noise(number, 7) + 0.04 * noise(x // 2, y // 2)
    colour = (152, 118, 96) if height > 0.3 else (186, 178, 164)
    return tuple(min(255, int(c * shade)) for c in colour) + (255,)


def wall_normal(x, y):
    def height(dx, dy):
        return brick((x + dx) % SIZE, (y + dy) % SIZE)[0]
    n = (1.2 * (height(-1, 0) - height(1, 0)), 1.2 * (height(0, 1) - height(0, -1)), 1.0)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(int(round(127.5 + 127.5 * c / length)) for c in n) + (255,)


def lattice(x, y):
    there = x < 14 or x % 38 < 7 or y % 16 < 5
    shade = 0.8 + 0.2 * noise(x // 3, y)
    return tuple(int(c * shade) for c in (142, 112, 78)) + (255 if there else 0,)


def ring(sides, low, high):
    """The sides of a tower between two rings, each (radius, height, place in the texture)."""
    def corner(side, level):
        angle = 2 * math.pi * side / sides
        return (level[0] * math.sin(angle), level[1], level[0] * math.cos(angle))
    return [((corner(i, low), corner(i + 1, low), corner(i + 1, high), corner(i, high)),
             [(i / 2, low[2]), ((i + 1) / 2, low[2]), ((i + 1) / 2, high[2]), (i / 2, high[2])])
            for i in range(sides)]


def box(low, high):
    quads = []
    for axis in range(3):
        for end in (low, high):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            if end is low:
                u, v = v, u
            corners = []
            for a, b in ((low, low), (high, low), (high, high), (low, high)):
                corner = [0.0] * 3
                corner[axis], corner[u], corner[v] = end[axis], a[u], b[v]
                corners.append(tuple(corner))
            quads.append((tuple(corners), [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]))
    return quads


def main():
    file = File()
    rough = {"metallicFactor": 0, "roughnessFactor": 1}
    bricks = file.add("materials", {
        "name": "bricks", "normalTexture": file.texture("bumps", SIZE, wall_normal),
        "pbrMetallicRoughness": {"baseColorTexture": file.texture("bricks", SIZE, wall), **rough}})
    def plain(name, colour, **more):
        return file.add("materials", {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": colour + [1], **rough}, **more})
    slate, oak = plain("slate", [0.07, 0.075, 0.09]), plain("oak", [0.16, 0.08, 0.035])
    glow = plain("glow", [0.9, 0.6, 0.3], emissiveFactor=[1, 0.62, 0.25],
                 extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 2.5}})
    slats = file.add("materials", {"name": "slats", "alphaMode": "MASK", "alphaCutoff": 0.5,
                                   "doubleSided": True, "pbrMetallicRoughness": {
                                       "baseColorTexture": file.texture("slats", SIZE, lattice), **rough}})
    tower = file.mesh("tower", ring(16, (3.83, -3.5, 6.75), (2.3, 10.0, 0.0)), bricks)
    roof = file.mesh("roof", ring(16, (2.75, 9.7, 0.0), (0.02, 12.8, 0.0)) +
                     ring(16, (2.2, 9.7, 0.0), (2.75, 9.7, 0.0)) +
                     box((-0.22, 10.35, 0.0), (0.22, 10.8, 3.3)), slate)
    lamp = file.mesh("lamp", box((-0.16, -0.22, -0.16), (0.16, 0.22, 0.16)), glow)
    door = file.mesh("door", box((0.0, 0.0, -0.07), (1.3, 2.3, 0.07)), oak)
    sail = file.mesh("sail", [
        (((-0.12, 0.5, 0.1), (1.5, 0.5, 0.4), (1.5, 7.4, 0.25), (-0.12, 7.4, 0.1)),
         [(0.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.0)])], slats)
    spar = file.mesh("spar", box((-0.14, -0.3, -0.12), (0.14, 7.5, 0.08)), oak)

    children = [{"name": "tower", "mesh": tower}, {"name": "roof", "mesh": roof},
                {"name": "lamp", "mesh": lamp, "translation": [1.25, 2.5, 3.35]},
                {"name": "door", "mesh": door, "translation": [-0.65, 0, 3.42]},
                {"name": "sails", "translation": [0, 10.57, 3.4], "children": []}]
    file.add("nodes", {"name": "mill", "children": list(range(1, 6))})
    for node in children:
        file.add("nodes", node)
    for i in range(4):
        half = math.pi / 4 * i
        turned = {"name": "sail_%d" % i, "mesh": sail, "rotation": [0, 0, math.sin(half), math.cos(half)]}
        turned["children"] = [file.add("nodes", {"name": "spar_%d" % i, "mesh": spar})]
        children[4]["children"].append(file.add("nodes", turned))

    def turns(axis, angles):
        out = []
        for angle in angles:
            q = [0.0, 0.0, 0.0, math.cos(math.radians(angle) / 2)]
            q[axis] = math.sin(math.radians(angle) / 2)
            out.append(tuple(q))
        return out
    file.animation("turn", 5, range(0, 9, 2), turns(2, (0, 90, 180, 270, 360)))
    file.animation("open", 4, (0, 2), turns(1, (0, 105)))
    file.write(sys.argv[1])


if __name__ == "__main__":
    main()
