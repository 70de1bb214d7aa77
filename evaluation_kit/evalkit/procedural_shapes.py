"""Shapes of procedural household things with random proportions; their largest extent is about 1, z is up."""

from collections import namedtuple

import numpy as np

from .procedural_surface import box, cross_section, extrude, join, lathe, rounded_outline, transformed, tube

# variant: name; patches: the closed surface; colours: part -> "main", "second", "metal" or "inside" (the part is what
# a region's name has before the slash; "main" by default); prints: region -> what a printed object has there.
Shape = namedtuple("Shape", "variant patches colours prints")


def _pick(rng, table):
    """One key of a {key: weight} table."""
    weights = np.array(list(table.values()), float)
    return list(table)[int(rng.choice(len(table), p=weights / weights.sum()))]


def _box_prints(size):
    """What is printed on a box's sides: the largest two are front and back, the smallest two the ends."""
    x, y, z = size
    pairs = sorted([(x * z, ("front", "back")), (y * z, ("left", "right")), (x * y, ("top", "bottom"))], reverse=True)
    roles = (("front", "back"), ("left", "right"), ("top", "bottom"))
    return {f"box/{side}": role for (_, sides), names in zip(pairs, roles) for side, role in zip(sides, names)}


def _box_size(rng, variant):
    u = rng.uniform
    if variant == "upright":
        size = [u(0.35, 0.8), u(0.14, 0.4), 1.0]
    elif variant == "flat":
        size = [1.0, u(0.6, 1.0), u(0.1, 0.28)]
    elif variant == "long":
        size = [1.0, u(0.17, 0.32), u(0.13, 0.26)]
    elif variant == "square":
        size = [u(0.4, 1.0), 0.0, 1.0]
        size[1] = size[0]
    else:
        size = [1.0, u(0.55, 0.9), u(0.45, 0.9)]
    return np.array(size)


def carton(rng):
    """A carton with sharp edges: upright, flat, long, with a square base, or compact."""
    variant = _pick(rng, {"upright": 4, "flat": 2, "long": 2, "square": 1, "compact": 2})
    size = _box_size(rng, variant)
    return Shape(variant + "_carton", box(size), {}, _box_prints(size))


def rounded_box(rng):
    """A box whose edges are rounded: a tin, a soap, a plastic case; some with a lid of another colour."""
    variant = _pick(rng, {"upright": 3, "flat": 3, "long": 2, "square": 1, "compact": 3})
    size = _box_size(rng, variant)
    radius = rng.uniform(0.12, 0.42) * size.min()
    return Shape(variant + "_rounded_box", box(size, radius, cells=7), {}, _box_prints(size))


def _span(a, b, rows):
    """Profile points from a to b, evenly spaced."""
    return [tuple(p) for p in np.linspace(a, b, rows + 1)]


def can(rng):
    """A can: food tin, flat tin, drinks can with a tapered top, or canister with a plastic lid."""
    variant = _pick(rng, {"tin": 5, "flat_tin": 2, "drinks_can": 2, "canister": 2})
    ratio = {"tin": (0.55, 0.95), "flat_tin": (1.5, 2.6), "drinks_can": (0.4, 0.58), "canister": (0.4, 0.9)}[variant]
    diameter, height = rng.uniform(*ratio), 1.0
    radius, height = np.array([diameter / 2, height]) / max(diameter, height)
    rim, deep = rng.uniform(0.02, 0.04) * radius + 0.006, rng.uniform(0.02, 0.05) * radius + 0.01
    narrow = radius * (rng.uniform(0.76, 0.88) if variant == "drinks_can" else 1.0)
    wide = narrow * (1.0 if variant == "drinks_can" else 1.02)
    inner = narrow * 0.93
    sections = [
        ("metal/bottom", [(0, deep), *_span((inner * 0.7, deep), (inner, deep), 3)], False),
        ("metal/foot", [(inner, deep), (inner * 1.01, 0.3 * rim), ((inner + wide) / 2, 0.0), (wide, 0.4 * rim),
                        (wide, rim), (narrow, 1.4 * rim)], True)]
    low, high = 1.4 * rim, height - 1.4 * rim
    taper = 0.12 * height if variant == "drinks_can" else 0.0
    if taper:
        flare = [(narrow, low), (0.5 * (narrow + radius), low + 0.03), (radius, low + 0.06)]
        sections.append(("metal/lower", flare, True))
        sections.append(("can/body", _span((radius, low + 0.06), (radius, high - taper), 14), False))
        share = np.linspace(0, 1, 6)
        bend = np.abs(np.cos(np.pi / 2 * share)) ** 0.8
        curve = [(narrow + (radius - narrow) * b, high - taper * (1 - s)) for b, s in zip(bend, share)]
        sections.append(("can/shoulder", curve, False))
    else:
        sections.append(("can/body", _span((radius, low), (radius, high), 16), True))
    if variant == "canister":
        cap = radius * 1.035
        sections += [("cap/ledge", [(radius, high), (cap, high)], True),
                     ("cap/side", _span((cap, high), (cap, height), 2), True),
                     ("cap/top", [(cap, height), *_span((cap * 0.92, height), (0, height), 3)], True)]
    else:
        sections += [("metal/rim", [(narrow, high), (wide, height - rim), (wide, height - 0.4 * rim),
                                    ((inner + wide) / 2, height), (inner * 1.01, height - 0.3 * rim),
                                    (inner, height - deep)], True),
                     ("metal/lid", [(inner, height - deep), (inner * 0.86, height - deep),
                                    (inner * 0.83, height - 0.8 * deep), *_span((inner * 0.8, height - 0.8 * deep),
                                                                              (0, height - 0.8 * deep), 3)], True)]
    return Shape(variant, lathe(sections), {"metal": "metal", "cap": "second"}, {"can/body": "wrap"})


def _bottle_profile(rng, kind, section, radius):
    """Sections of a bottle whose height is 1 without its cap's upper half; also where the neck and the cap's top are.

    section: half the smaller width of the body's cross-section relative to the larger; radius: of the body.
    """
    jar = kind == "jar"
    heel = rng.uniform(0.08, 0.3) * radius * section
    neck = radius * section * (rng.uniform(0.78, 0.92) if jar else rng.uniform(0.28, 0.6))
    shoulder = rng.uniform(0.05, 0.09) if jar else rng.uniform(0.1, 0.28)
    cap_height = rng.uniform(0.1, 0.2) if jar else rng.uniform(0.07, 0.18)
    neck_height = rng.uniform(0.01, 0.03) if jar else rng.uniform(0.01, 0.12)
    cap = neck * (rng.uniform(1.03, 1.12) if jar or rng.random() < 0.7 else rng.uniform(1.2, 1.6))
    cap = min(cap, radius * section * 1.05)
    waist = rng.choice([0.0, rng.uniform(-0.06, 0.1)])
    z_body, z_neck = 1 - cap_height - neck_height - shoulder, 1 - cap_height - neck_height
    t = np.linspace(0, np.pi / 2, 6)
    heel_curve = [(radius - heel + heel * np.sin(a), heel - heel * np.cos(a)) for a in t]
    s = np.linspace(0, 1, 15)
    body = [(radius * (1 - waist * np.sin(np.pi * v)), heel + (z_body - heel) * v) for v in s]
    power = rng.uniform(0.8, 1.6)
    s = np.linspace(0, 1, 11)
    bend = (s ** power) ** 2 * (3 - 2 * s ** power)
    shoulders = [(radius + (neck - radius) * b, z_body + shoulder * v, b) for v, b in zip(s, bend)]
    bevel = 0.12 * cap
    return [("bottle/bottom", [(0, 0), *_span((0.5 * (radius - heel), 0), (radius - heel, 0), 2)], False),
            ("bottle/heel", heel_curve, True),
            ("bottle/body", body, False), ("bottle/shoulder", shoulders, False),
            ("bottle/neck", _span((neck, z_neck, 1), (neck, z_neck + neck_height, 1), 2), False),
            ("cap/ledge", [(neck, z_neck + neck_height, 1), (cap, z_neck + neck_height, 1)], True),
            ("cap/side", _span((cap, z_neck + neck_height, 1), (cap, 1 - bevel, 1), 3), True),
            ("cap/edge", [(cap, 1 - bevel, 1), (cap - 0.3 * bevel, 1 - 0.3 * bevel, 1), (cap - bevel, 1, 1)], False),
            ("cap/top", [(cap - bevel, 1, 1), (0.5 * cap, 1, 1), (0, 1, 1)], True)], body, cap


def bottle(rng):
    """A bottle or jar: round, oval, with a spray head, or with a handle."""
    variant = _pick(rng, {"bottle": 3, "oval_bottle": 3, "jar": 3, "spray_bottle": 2, "handled_bottle": 2})
    oval = variant == "oval_bottle" or (variant in ("spray_bottle", "handled_bottle") and rng.random() < 0.5)
    aspect, exponent = (rng.uniform(0.42, 0.75), rng.uniform(2.0, 3.4)) if oval else (1.0, 2.0)
    if variant == "jar" and rng.random() < 0.25:
        exponent = rng.uniform(3.0, 4.5)
    radius = rng.uniform(0.3, 0.5) if variant == "jar" else rng.uniform(0.15, 0.24) * (1.25 if oval else 1.0)
    sections, body, cap = _bottle_profile(rng, variant, aspect, radius)
    parts = [lathe(sections, cross_section(aspect, exponent), cross_section())]
    if variant == "spray_bottle":
        parts += _spray_head(rng, radius, min(cap, 0.8 * radius * aspect))
    if variant == "handled_bottle":
        low, high = (body[int(k)] for k in (rng.integers(2, 5), rng.integers(10, 13)))
        out = rng.uniform(0.35, 0.7) * (high[1] - low[1])
        parts.append(_handle(low, high, out, 0.14 * radius, rng.uniform(0.35, 0.5) * radius, rng.uniform(2.2, 4)))
    return Shape(variant, join(parts), {"cap": "second", "head": "second"}, {"bottle/body": "bottle"})


def _handle(low, high, out, sunk, thick, exponent):
    """A handle in the x, z plane between two points (r, z) of a wall, its ends `sunk` into the wall."""
    bow, rise = cross_section(1.0, exponent, 56)[np.r_[42:56, 0:15]].T   # from -z over +x to +z
    share = (rise + 1) / 2
    x = low[0] + (high[0] - low[0]) * share - sunk + (out + sunk) * bow
    z = low[1] + (high[1] - low[1]) * share
    return tube(np.stack([x, np.zeros_like(x), z], 1), thick, 0.8 * thick, "handle")


def _spray_head(rng, radius, cap):
    """A trigger head on the cap of a bottle: an extruded outline in the x, z plane and a trigger."""
    s = rng.uniform(1.3, 1.9) * radius
    corners = np.array([(-0.42, 0.22), (-0.4, 0.5), (-0.2, 0.6), (0.45, 0.52), (0.62, 0.5), (0.62, 0.36), (0.28, 0.33),
                        (0.14, -0.04), (-0.16, -0.04)])
    width = rng.uniform(1.1, 1.5) * cap
    outline = rounded_outline(corners * s, 0.06 * s, 0.04 * s)
    to_xz = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    head = transformed(extrude(outline, width, 0.05 * s, "head", 0.04 * s), to_xz, [0, width / 2, 1.0])
    path = np.array([(0.36, 0.4), (0.38, 0.28), (0.36, 0.16), (0.37, 0.05), (0.43, -0.08), (0.5, -0.18)]) * s
    trigger = tube(np.stack([path[:, 0], 0 * path[:, 0], 1 + path[:, 1]], 1), 0.5 * width, 0.08 * s, "head")
    return [head, trigger]


def _hollow(outer, wall, name, floor):
    """Sections of an open vessel from the (r, z) points of its outer wall, up to the rim; `floor`: thickness."""
    top = outer[-1][1]
    inner = [(max(r - wall, 0.3 * r), max(z, floor)) for r, z in outer if z > floor * 1.2]
    knee = (inner[0][0] * 0.97, floor * 1.05)
    inner, bend = [knee] + inner, [(0.0, floor), (0.5 * knee[0], floor), (0.92 * knee[0], floor), knee]
    t = np.linspace(0, np.pi, 7)
    rim = [(outer[-1][0] - wall / 2 + wall / 2 * np.cos(a), top + wall / 2 * np.sin(a)) for a in t]
    bottom = [(0, 0), (0.5 * outer[0][0], 0), (outer[0][0], 0)]
    return [(f"{name}/bottom", bottom, False), (f"{name}/body", outer, True), (f"{name}/rim", rim, False),
            ("inside/wall", inner[::-1], False), ("inside/floor", bend[::-1], False)]


def vessel(rng):
    """A mug with a handle, a cup without, or a bowl; hollow."""
    variant = _pick(rng, {"mug": 5, "cup": 3, "bowl": 3})
    u = rng.uniform
    wall = u(0.035, 0.05)
    s = np.linspace(0, 1, 17)
    if variant == "bowl":
        radius, height, foot, power = 0.5, u(0.28, 0.5), u(0.2, 0.32), u(0.4, 0.65)
        outer = [(foot + (radius - foot) * v ** power, height * v) for v in s ** 1.6]
        sections, parts = _hollow(outer, wall, "bowl", 1.5 * wall), []
    else:
        foot = u(0.7, 0.95) if variant == "cup" or rng.random() < 0.4 else 1.0
        radius, height, belly = u(0.36, 0.5), u(0.85, 1.0), rng.choice([0.0, u(0.0, 0.12)])
        heel = u(0.03, 0.1) * radius
        outer = [(radius * (foot + (1 - foot) * v + belly * np.sin(np.pi * v)), height * v) for v in s]
        outer = [(outer[0][0] - heel, 0.0), (outer[0][0] - 0.3 * heel, 0.3 * heel), (outer[0][0], heel)] + outer[1:]
        sections, parts = _hollow(outer, wall, variant, 1.4 * wall), []
    if variant == "mug":
        low, high = outer[int(rng.integers(5, 7))], outer[int(rng.integers(14, 17))]
        parts = [_handle(low, high, u(0.22, 0.34), wall / 2, u(0.1, 0.15), u(2.0, 4.0))]
    patches = join([lathe(sections)] + parts)
    return Shape(variant, patches, {"handle": rng.choice(["main", "main", "second"]), "inside": "inside"},
                 {f"{variant}/body": "wrap_loose"})
