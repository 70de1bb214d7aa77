"""Pieces of random print on RGB images (uint8): words, text, pictures, stripes, barcodes, nutrition tables.

A box is (x, y, width, height) as fractions of the image. Every random choice comes from the given generator.
"""

import cv2
import numpy as np

from .textures import value_noise

SYLLABLES = ["ka", "lo", "mi", "ra", "ven", "tor", "zu", "pe", "ni", "sol", "bel", "ro", "da", "fi", "ko", "ma", "lux",
             "ta", "vi", "po", "gra", "sta", "el", "or", "an", "qui", "bro", "he", "ju", "wal"]
NOUNS = ["original", "classic", "fresh", "natural", "family pack", "extra fine", "with vitamin C", "since 1928",
         "250 g", "500 ml", "new recipe", "finest quality", "no sugar", "intense", "for daily use", "limited edition", "100%"]
FONTS = [cv2.FONT_HERSHEY_SIMPLEX, cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_COMPLEX, cv2.FONT_HERSHEY_TRIPLEX]
BRAND_FONTS = FONTS + [cv2.FONT_HERSHEY_SCRIPT_COMPLEX, cv2.FONT_HERSHEY_DUPLEX]


def word(rng, least=2, most=3):
    """A made-up word."""
    return "".join(rng.choice(SYLLABLES, int(rng.integers(least, most + 1))))


def _span(image, box):
    """Pixel slices of a box, at least one pixel wide and within the image."""
    h, w = image.shape[:2]
    spans = []
    for first, extent, size in ((box[1], box[3], h), (box[0], box[2], w)):
        start = int(np.clip(round(first * size), 0, size - 1))
        spans.append(slice(start, int(np.clip(round((first + extent) * size), start + 1, size))))
    return tuple(spans)


def window(image, box):
    """The view of a box in an image; drawing into it draws into the image."""
    rows, columns = _span(image, box)
    return image[rows, columns]


def blend(image, mask, colour):
    """Blends a colour, or an image, into an image by a mask (0..1)."""
    mask = mask[:, :, None].astype(np.float32)
    image[:] = np.clip(image * (1 - mask) + np.asarray(colour, np.float32) * mask + 0.5, 0, 255).astype(np.uint8)


def text(image, content, box, colour, font=cv2.FONT_HERSHEY_SIMPLEX, weight=3, slant=0.0, align="centre"):
    """One line of text as large as a box allows, stretched by up to a quarter; weight: stroke at 60 px height."""
    target = window(image, box)
    (w, h), below = cv2.getTextSize(content, font, 2.0, weight)
    pad = weight + int(abs(slant) * h) + 2
    mask = np.zeros((h + below + 2 * pad, w + 2 * pad), np.uint8)
    cv2.putText(mask, content, (pad, h + pad), font, 2.0, 255, weight, cv2.LINE_AA)
    if slant:
        shear = np.float32([[1, -slant, slant * mask.shape[0] / 2], [0, 1, 0]])
        mask = cv2.warpAffine(mask, shear, mask.shape[::-1])
    mask = mask[:, np.flatnonzero(mask.any(0))[0]:np.flatnonzero(mask.any(0))[-1] + 1]
    mask = mask[np.flatnonzero(mask.any(1))[0]:np.flatnonzero(mask.any(1))[-1] + 1]
    th, tw = target.shape[:2]
    sy = th / mask.shape[0]
    sx = min(tw / mask.shape[1], 1.25 * sy)
    sy = min(sy, 1.25 * sx)
    size = max(1, min(tw, round(mask.shape[1] * sx))), max(1, min(th, round(mask.shape[0] * sy)))
    mask = cv2.resize(mask, size, interpolation=cv2.INTER_AREA if sx < 1 else cv2.INTER_CUBIC)
    x = 0 if align == "left" else (tw - size[0]) // 2
    y = (th - size[1]) // 2
    blend(target[y:y + size[1], x:x + size[0]], mask / 255.0, colour)


def lines(rng, image, box, colour, height_px):
    """A paragraph of small print with lines of about `height_px` pixels."""
    target = window(image, box)
    count = int(np.clip(target.shape[0] / (1.5 * height_px), 1, 24))
    letters = max(6, int(target.shape[1] / (0.7 * height_px)))
    for k in range(count):
        content = " ".join(word(rng, 1, 4) for _ in range(30))[:letters]
        if k == count - 1:
            content = content[:max(3, letters // 2)]
        text(target, content, (0.0, (k + 0.1) / count, len(content) / letters, 0.8 / count), colour, weight=3,
             align="left")


def barcode(rng, image, box):
    """Black bars on white."""
    target = window(image, box)
    target[:] = 250
    h, w = target.shape[:2]
    runs = rng.integers(1, 4, 48)
    edges = np.cumsum(runs) / runs.sum()
    at = np.searchsorted(edges, (np.arange(4 * w) + 0.5) / (4 * w))
    bars = np.where(at % 2 == 0, 20.0, 250.0).reshape(w, 4).mean(1)
    x = slice(int(0.08 * w), max(int(0.92 * w), int(0.08 * w) + 1))
    target[int(0.06 * h):max(1, int(0.78 * h)), x] = bars[x][None, :, None].astype(np.uint8)
    digits = "".join(str(d) for d in rng.integers(0, 10, 13))
    text(target, digits, (0.1, 0.81, 0.8, 0.15), (20, 20, 20))


def nutrition_table(rng, image, box, colour, paper):
    """A ruled table of names and numbers."""
    target = window(image, box)
    target[:] = np.asarray(paper, np.uint8)
    h, w = target.shape[:2]
    rows = int(np.clip(h / 14, 3, 9))
    text(target, "Nutrition facts", (0.04, 0.02, 0.9, 0.8 / (rows + 1)), colour, cv2.FONT_HERSHEY_DUPLEX, 5)
    for k in range(1, rows + 1):
        y = k / (rows + 1)
        cv2.line(target, (0, int(y * h)), (w, int(y * h)), colour, 1)
        text(target, word(rng, 2, 4), (0.04, y + 0.02, 0.5, 0.75 / (rows + 1)), colour, align="left")
        text(target, f"{rng.uniform(0, 90):.1f} g", (0.68, y + 0.02, 0.28, 0.75 / (rows + 1)), colour)
    cv2.rectangle(target, (0, 0), (w - 1, h - 1), colour, 1)


def picture(rng, image, box, colours, shape="ellipse"):
    """A picture of blobs: noise in a few colours with round things on it, in an ellipse or a rectangle."""
    target = window(image, box)
    h, w = target.shape[:2]
    size = 192
    field = value_noise(rng, size, 3, 5)
    levels = np.digitize(field, np.quantile(field, np.sort(rng.uniform(0.15, 0.85, 3))))
    tones = np.array([colours[int(rng.integers(len(colours)))] for _ in range(4)], np.float32)
    canvas = tones[levels] * (1 + 0.25 * value_noise(rng, size, 6, 4)[:, :, None])
    canvas = np.clip(canvas, 0, 255).astype(np.uint8)
    for _ in range(int(rng.integers(3, 9))):
        centre, radius = rng.integers(10, size - 10, 2), rng.uniform(0.06, 0.2) * size
        tone = np.array(colours[int(rng.integers(len(colours)))], float)
        axes = (int(radius), int(radius * rng.uniform(0.5, 1.0)))
        angle = float(rng.uniform(0, 180))
        for f in np.linspace(1, 0.25, 6):   # shaded like a ball
            shade = [float(v) for v in np.clip(tone * (1.25 - 0.6 * f), 0, 255)]
            at = (int(centre[0] - (1 - f) * radius * 0.3), int(centre[1] - (1 - f) * radius * 0.3))
            cv2.ellipse(canvas, at, (int(axes[0] * f), int(axes[1] * f)), angle, 0, 360, shade, -1, cv2.LINE_AA)
    mask = np.zeros((h, w), np.uint8)
    if shape == "ellipse":
        cv2.ellipse(mask, (w // 2, h // 2), (max(w // 2 - 1, 1), max(h // 2 - 1, 1)), 0, 0, 360, 255, -1, cv2.LINE_AA)
    else:
        mask[:] = 255
    blend(target, mask / 255.0, cv2.resize(canvas, (w, h), interpolation=cv2.INTER_LINEAR))


def ellipse(image, box, colour, rim=None):
    """A filled ellipse, with a rim of another colour."""
    target = window(image, box)
    h, w = target.shape[:2]
    for f, tone in ((1.0, rim), (0.9, colour)) if rim is not None else ((1.0, colour),):
        axes = (max(int(w / 2 * f) - 1, 1), max(int(h / 2 * f) - 1, 1))
        cv2.ellipse(target, (w // 2, h // 2), axes, 0, 0, 360, [float(v) for v in tone], -1, cv2.LINE_AA)


def stripes(rng, image, box, colours):
    """Level stripes across the whole width of a box."""
    target = window(image, box)
    edges = np.cumsum(rng.uniform(0.4, 1.6, int(rng.integers(2, 6))))
    at = np.searchsorted(edges / edges[-1], (np.arange(len(target)) + 0.5) / len(target))
    target[:] = np.asarray(colours, np.uint8)[at % len(colours)][:, None]


def star(rng, image, box, colour, ink):
    """A badge with teeth and a short word on it."""
    target = window(image, box)
    h, w = target.shape[:2]
    teeth = int(rng.integers(9, 16))
    angle = np.arange(2 * teeth) / teeth * np.pi
    radius = np.where(np.arange(2 * teeth) % 2, 0.4, 0.49) * min(h, w)
    points = np.stack([w / 2 + radius * np.cos(angle), h / 2 + radius * np.sin(angle)], 1)
    cv2.fillPoly(target, [np.round(points * 16).astype(np.int32)], [float(v) for v in colour], cv2.LINE_AA, 4)
    text(target, str(rng.choice(["NEW", "-20%", "BIO", "XXL", "2 in 1"])), (0.22, 0.36, 0.56, 0.28), ink, weight=6)
