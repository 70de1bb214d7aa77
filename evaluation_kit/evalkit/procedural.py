"""Procedural household things: as many textured objects as a seed asks for, each a function of (seed, number).

An object is a folder as objects/README.md describes. Shapes are in procedural_shapes and procedural_tools, their
surfaces in procedural_surface, texture in procedural_print and procedural_labels.
"""

import os

import cv2
import numpy as np
import yaml

from .mesh import distinct_resting_poses, load_mesh
from .procedural_print import Palette, Printer
from .procedural_shapes import bottle, can, carton, rounded_box, vessel
from .procedural_symmetry import SymmetryFinder
from .procedural_tools import tool
from .textures import value_noise

# Kind: shape and range of the largest extent in metres.
KINDS = {"carton": (carton, 0.025, 0.30), "rounded_box": (rounded_box, 0.02, 0.25), "can": (can, 0.05, 0.20),
         "bottle": (bottle, 0.05, 0.30), "vessel": (vessel, 0.05, 0.22), "tool": (tool, 0.08, 0.30)}
TEXTURE = 1024     # px
GUTTER = 6         # px round every region, which filtered colours may be taken from
FIRST_ID = 10000
STYLES = ["plain"] * 6 + ["faint"] * 2 + ["sparse"] * 3 + ["full"] * 9


def kind_of(seed, number, kinds):
    """The kind of an object: every run of len(kinds) numbers has each once, in random order."""
    turn = np.random.default_rng([seed, 1, number // len(kinds)]).permutation(len(kinds))
    return kinds[turn[number % len(kinds)]]


def _extent(rng, low, high):
    """Largest extent (m): mostly 60 to 250 mm, within the kind's range."""
    usual = (max(low, 0.06), min(high, 0.25))
    a, b = usual if rng.random() < 0.85 else (low, high)
    return float(np.exp(rng.uniform(np.log(a), np.log(b))))


def _pack(patches, scale):
    """Shelf packing: upper left corners and sizes (px) of the regions, or None if the texture is too small.

    scale: px per metre of what is printed on; the rest needs no detail.
    """
    sizes = [np.maximum(np.ceil(p.size * scale * (1.0 if p.printed else 0.35)).astype(int), 2) for p in patches]
    places, x, y, shelf = [None] * len(patches), 0, 0, 0
    for k in sorted(range(len(patches)), key=lambda i: (-sizes[i][1], i)):
        w, h = sizes[k] + 2 * GUTTER
        if x + w > TEXTURE:
            x, y, shelf = 0, y + shelf, 0
        if w > TEXTURE or y + h > TEXTURE:
            return None
        places[k] = (x + GUTTER, y + GUTTER, *sizes[k])
        x, shelf = x + w, max(shelf, h)
    return places


def _layout(patches):
    """Places (x, y, w, h) px of all regions in the texture, and the largest px per metre for which they fit."""
    low, high = 1.0, 2e5
    for _ in range(40):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if _pack(patches, middle) else (low, middle)
    return _pack(patches, low), low


def style_of(seed, number):
    """How an object is printed: "plain", "faint" (low contrast), "sparse" (a side or two) or "full"."""
    turn = np.random.default_rng([seed, 2, number // len(STYLES)]).permutation(len(STYLES))
    return STYLES[turn[number % len(STYLES)]]


def _choose_prints(rng, prints, style):
    """Region -> what is printed there, for a style of print."""
    if style == "plain":
        return {}
    if style == "sparse":
        chosen = [region for region, role in prints.items() if role not in ("side", "end", "left", "right", "bottom")]
        sparse = {"wrap": "patch", "bottle": "patch"}
        return {region: sparse.get(prints[region], prints[region]) for region in chosen[:int(rng.integers(1, 3))]}
    return dict(prints)


def _paint_box(rng, printer, regions, images):
    """Paints a box's sides; of two in five the opposite sides are alike but for small print."""
    alike, seeds = rng.random() < 0.4, rng.integers(1 << 30, size=3)

    def draw(role, what, seed):
        if role in regions:
            what(np.random.default_rng(seed), images[regions[role]])

    draw("front", printer.front, seeds[0])
    draw("left", printer.side, seeds[1])
    draw("top", printer.end, seeds[2])
    draw("back", printer.front if alike else printer.back, seeds[0])
    draw("right", printer.side if alike else printer.back, seeds[1])
    draw("bottom", printer.end, seeds[2])
    if alike and "back" in regions:
        printer.small_print(rng, images[regions["back"]])


def _paint(rng, shape, patches, places, scale, palette, contrast):
    """The texture of an object."""
    texture = np.zeros((TEXTURE, TEXTURE, 3), np.uint8)
    texture[:] = palette.main.astype(np.uint8)
    printer = Printer(rng, palette, scale)
    images = {}
    for patch, (x, y, w, h) in zip(patches, places):
        colour = getattr(palette, str(shape.colours.get(patch.region.split("/")[0], "main")))
        images[patch.region] = np.full((h, w, 3), colour).astype(np.uint8)
    before = {name: image.copy() for name, image in images.items()}
    if any(role in ("front", "back") and name.startswith("box/") for name, role in shape.prints.items()):
        _paint_box(rng, printer, {patch.role: patch.region for patch in patches if patch.printed}, images)
    else:
        for patch in patches:
            if patch.printed:
                getattr(printer, patch.role)(rng, images[patch.region])
    for patch, (x, y, w, h) in zip(patches, places):
        image = images[patch.region].astype(np.float32)
        image = before[patch.region] + (image - before[patch.region]) * contrast
        framed = cv2.copyMakeBorder(image, GUTTER, GUTTER, GUTTER, GUTTER, cv2.BORDER_REPLICATE)
        texture[y - GUTTER:y + h + GUTTER, x - GUTTER:x + w + GUTTER] = np.clip(framed + 0.5, 0, 255).astype(np.uint8)
    mottle = 1 + 0.012 * value_noise(rng, TEXTURE, 24, 4)
    return np.clip(texture * mottle[:, :, None] + 0.5, 0, 255).astype(np.uint8)


def _number_regions(patches):
    """Gives regions whose name occurs before a number."""
    seen = {}
    for patch in patches:
        seen[patch.region] = seen.get(patch.region, 0) + 1
        if seen[patch.region] > 1:
            patch.region += f"_{seen[patch.region]}"
    return patches


def _write_obj(path, patches, places):
    """Writes the patches as OBJ: vertices welded, normals and texture coordinates per corner."""
    points = np.concatenate([p.points for p in patches])
    _, first, index = np.unique(np.floor(points * 1e6 + 0.1234567).astype(np.int64), axis=0, return_index=True,
                                return_inverse=True)
    index = index.reshape(-1)
    offsets = np.cumsum([0] + [len(p.points) for p in patches])
    rows = ["mtllib textured.mtl", "usemtl material_0"]
    rows += ["v %.7f %.7f %.7f" % tuple(p) for p in points[first]]
    for patch, (x, y, w, h) in zip(patches, places):
        uv = patch.uv / patch.size * [w, h]
        uv = np.stack([(x + uv[:, 0]) / TEXTURE, 1 - (y + h - uv[:, 1]) / TEXTURE], 1)
        rows += ["vt %.6f %.6f" % tuple(p) for p in uv]
    for patch in patches:
        rows += ["vn %.4f %.4f %.4f" % tuple(n) for n in patch.normals]
    for patch, offset in zip(patches, offsets):
        for face in patch.faces + offset:
            a, b, c = index[face]
            if a != b and b != c and c != a:
                rows.append("f " + " ".join(f"{index[k] + 1}/{k + 1}/{k + 1}" for k in face))
    with open(path, "w") as f:
        f.write("\n".join(rows) + "\n")


def _specular(rng, metal):
    """Strength and exponent of the highlight: mostly matt."""
    if rng.random() < (0.5 if metal else 0.15):
        return [round(float(rng.uniform(0.08, 0.15)), 3), round(float(rng.uniform(40, 70)), 1)]
    return [round(float(rng.uniform(0.01, 0.06)), 3), round(float(rng.uniform(15, 30)), 1)]


def _write_once(rng, kind, style, folder):
    """Draws an object and writes its mesh and texture; returns (variant, specular)."""
    make, low, high = KINDS[kind]
    shape = make(rng)
    patches = _number_regions(shape.patches)
    points = np.concatenate([p.points for p in patches])
    extent = _extent(rng, low, high)
    scale = extent / np.ptp(points, axis=0).max()
    middle = np.append((points[:, :2].min(0) + points[:, :2].max(0)) / 2, points[:, 2].min())
    contrast = float(rng.uniform(0.12, 0.35)) if style == "faint" else 1.0
    chosen = _choose_prints(rng, shape.prints, style)
    for patch in patches:
        patch.points, patch.uv = (patch.points - middle) * scale, patch.uv * scale
        patch.size = np.maximum(patch.uv.max(0), 1e-9)
        patch.role = chosen.get(patch.region, "")
        patch.printed = bool(patch.role)
    places, pixels = _layout(patches)
    texture = _paint(rng, shape, patches, places, pixels, Palette(rng), contrast)
    os.makedirs(folder, exist_ok=True)
    _write_obj(os.path.join(folder, "textured.obj"), patches, places)
    with open(os.path.join(folder, "textured.mtl"), "w") as f:
        f.write("newmtl material_0\nKd 1 1 1\nmap_Kd texture.jpg\n")
    cv2.imwrite(os.path.join(folder, "texture.jpg"), texture[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, 95])
    return shape.variant, _specular(rng, "metal" in shape.colours.values())


def write_object(out, seed, number, kinds=tuple(KINDS)):
    """Writes object `number` of `seed` into a folder of its own in `out`; returns its metadata.

    An object that does not stand in two poses at least 50 degrees apart is drawn again.
    """
    kind, style = kind_of(seed, number, list(kinds)), style_of(seed, number)
    name = f"{kind}_{seed}_{number:04d}"
    folder = os.path.join(out, name)
    for attempt in range(20):
        rng = np.random.default_rng([seed, 0, number, attempt])
        variant, specular = _write_once(rng, kind, style, folder)
        mesh = load_mesh(os.path.join(folder, "textured.obj"))
        if len(distinct_resting_poses(mesh, 2)) == 2:
            break
    else:
        raise RuntimeError(f"{name}: no object with two resting poses in 20 attempts")
    finder = SymmetryFinder(mesh)
    symmetries = finder.entries(colour=True)
    metadata = {"id": FIRST_ID + 10000 * seed + number, "name": name, "kind": kind, "variant": variant, "print": style,
                "specular": specular, "symmetric": bool(symmetries), "symmetries": symmetries,
                "shape_symmetries": finder.entries(colour=False)}
    with open(os.path.join(folder, "object.yaml"), "w") as f:
        yaml.safe_dump(metadata, f, sort_keys=False, default_flow_style=None, width=119)
    return metadata
