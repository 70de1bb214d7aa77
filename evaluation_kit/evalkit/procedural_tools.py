"""Shapes of procedural tools: extruded outlines joined together; largest extent about 1, lying flat, z up."""

import numpy as np

from .procedural_shapes import Shape, _pick
from .procedural_surface import extrude, join, lathe, rounded_outline, transformed

SPACING = 0.016
TO_XZ = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])   # an outline in x, y stands up in x, z


def _plate(corners, radii, thickness, bevel, name, middle=0.0):
    """An extruded outline whose thickness is centred on z = `middle`."""
    outline = rounded_outline(corners, radii, SPACING)
    return transformed(extrude(outline, thickness, bevel, name, SPACING), translation=[0, 0, middle - thickness / 2])


def _mirrored(half):
    """A closed outline symmetric about the x axis from the points of its upper half, left to right."""
    half = np.asarray(half, float)
    return np.concatenate([half, half[::-1] * [1, -1]])


def hammer(rng):
    """A handle with a grip, across it a head with a face on one side and a peen or claw on the other."""
    u = rng.uniform
    w, grip = u(0.028, 0.04), u(1.2, 1.6)
    handle = _mirrored([(0.0, w * grip * 0.8), (0.08, w * grip), (0.3, w * grip), (0.42, w), (0.96, w * 0.9)])
    thick = u(0.045, 0.065)
    h, face, long = u(0.045, 0.06), u(0.055, 0.075), u(0.13, 0.19)
    x = 0.94
    tip = u(-0.05, 0.02)
    head = [(x - h * 0.8, -0.06), (x - face, -long * 0.7), (x - face, -long), (x + face, -long),
            (x + face, -long * 0.7), (x + h * 0.8, -0.06), (x + h, 0.05), (x + tip, long * 0.98), (x + tip - 0.03, long), (x - h, 0.05)]
    parts = [_plate(handle, 0.02, thick, 0.012, "handle"), _plate(head, 0.012, thick * u(1.3, 1.7), 0.01, "head")]
    return Shape("hammer", join(parts), {"handle": "main", "head": rng.choice(["metal", "second"])},
                 {"handle/upper": "strip", "handle/under": "strip"})


def _jaw(x, radius, opening, name, thickness, direction):
    """The open end of a spanner about (x, 0), its mouth towards +x or -x."""
    angle = np.radians(np.linspace(40, 320, 15))
    arc = radius * np.stack([np.cos(angle), np.sin(angle)], 1)
    mouth = [(radius * 0.86, -opening), (-0.1 * radius, -opening), (-0.35 * radius, 0), (-0.1 * radius, opening),
             (radius * 0.86, opening)]
    outline = np.concatenate([arc, mouth])
    turn = np.radians(15)
    outline = outline @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return _plate(outline * direction + [x, 0], 0.008, thickness, 0.006, name)


def _ring(x, radius, hole, thickness):
    """The ring end of a spanner about (x, 0)."""
    e, h = 0.15 * (radius - hole), thickness / 2
    profile = [("head/outer", [(radius - e, -h), (radius, e - h), (radius, h - e), (radius - e, h)], False),
               ("head/upper", [(radius - e, h), (hole + e, h)], True),
               ("head/inner", [(hole + e, h), (hole, h - e), (hole, e - h), (hole + e, -h)], True),
               ("head/under", [(hole + e, -h), (radius - e, -h)], True)]
    return transformed(lathe(profile), translation=[x, 0, 0])


def spanner(rng):
    """An open jaw at one end of a shank, a ring or another jaw at the other."""
    u = rng.uniform
    thick, radius = u(0.035, 0.055), u(0.09, 0.12)
    w = u(0.3, 0.42) * radius
    shank = _mirrored([(0.1, w), (0.3, 0.8 * w), (0.7, 0.8 * w), (0.9, w)])
    parts = [_plate(shank, 0.01, 0.62 * thick, 0.006, "shank"),
             _jaw(1 - radius, radius, u(0.42, 0.55) * radius, "head", thick, 1)]
    if rng.random() < 0.5:
        parts.append(_ring(radius, u(0.85, 1.0) * radius, u(0.5, 0.6) * radius, thick * 1.1))
    else:
        small = u(0.75, 1.0) * radius
        parts.append(_jaw(small, small, 0.5 * small, "head", thick, -1))
    colours = rng.choice([["metal", "metal"], ["main", "metal"], ["main", "main"]])
    return Shape("spanner", join(parts), {"shank": str(colours[0]), "head": str(colours[1])},
                 {"shank/upper": "strip", "shank/under": "strip"})


def remote(rng):
    """A remote control: a rounded plate with a raised key field."""
    u = rng.uniform
    w, end, thick = u(0.11, 0.17), u(0.09, 0.17), u(0.07, 0.12)
    body = _mirrored([(0.0, w), (0.5, w * u(0.85, 1.0)), (1.0, end)])
    field = _mirrored([(0.3, 0.7 * min(w, end)), (0.88, 0.7 * min(w, end))])
    disc = 0.5 * min(w, end)
    angle = np.arange(24) / 24 * 2 * np.pi
    knob = np.stack([0.17 + disc * np.cos(angle), disc * np.sin(angle)], 1)
    parts = [_plate(body, 0.04, thick, 0.02, "body"),
             _plate(field, 0.015, 0.04, 0.008, "field", thick / 2 - 0.01),
             _plate(knob, 0.0, 0.04, 0.008, "knob", thick / 2 - 0.008)]
    return Shape("remote", join(parts), {"field": rng.choice(["main", "second"]), "knob": "second"},
                 {"field/upper": "keys", "body/upper": "strip", "body/under": "back"})


def stapler(rng):
    """A base, a hinge and an arm above it, all outlines in the x, z plane."""
    u = rng.uniform
    base_width, arm_width = u(0.2, 0.28), u(0.15, 0.2)
    base_height, gap, rise = u(0.05, 0.08), u(0.03, 0.09), u(0.12, 0.2)
    z = base_height + gap
    base = [(0, 0), (1, 0), (1, 0.7 * base_height), (0.93, base_height), (0, base_height)]
    arm = [(0.02, base_height + 0.015), (0.3, base_height + 0.02), (0.97, z + 0.3 * gap), (1.0, z + 0.05),
           (0.9, z + 0.6 * rise), (0.45, z + rise), (0.08, z + 0.7 * rise), (0.0, z)]
    hinge = [(0.04, 0.5 * base_height), (0.26, 0.5 * base_height), (0.22, z + 0.3 * rise), (0.06, z + 0.3 * rise)]
    parts = [_plate(base, 0.015, base_width, 0.012, "base"), _plate(arm, 0.03, arm_width, 0.016, "arm"),
             _plate(hinge, 0.01, 0.8 * arm_width, 0.008, "hinge")]
    return Shape("stapler", [p.transformed(TO_XZ) for p in join(parts)],
                 {"base": rng.choice(["main", "second"]), "hinge": "metal"},
                 {"arm/upper": "strip", "arm/under": "strip", "base/upper": "strip"})


def spatula(rng):
    """A blade, such as a filling knife's or a turner's, in a handle."""
    u = rng.uniform
    w, blade = u(0.04, 0.055), u(0.09, 0.18)
    start = u(0.4, 0.55)
    handle = _mirrored([(0, 0.8 * w), (0.05, w), (0.25, 0.85 * w), (start, 0.7 * w)])
    flat = _mirrored([(start - 0.08, 0.4 * w), (start + 0.1, 0.6 * w), (start + 0.22, blade),
                      (1.0, blade * u(0.85, 1.1))])
    parts = [_plate(handle, 0.03, u(0.05, 0.08), 0.015, "handle"), _plate(flat, 0.02, 0.022, 0.004, "blade")]
    return Shape("spatula", join(parts), {"blade": rng.choice(["metal", "second"])},
                 {"handle/upper": "strip", "handle/under": "strip"})


def tool(rng):
    """A hammer, spanner, remote control, stapler or spatula."""
    return {"hammer": hammer, "spanner": spanner, "remote": remote, "stapler": stapler, "spatula": spatula}[
        _pick(rng, {"hammer": 1, "spanner": 1, "remote": 1, "stapler": 1, "spatula": 1})](rng)
