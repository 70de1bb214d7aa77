"""What is printed on procedural objects: colours, and the composition of front, back, side, end and wrapped labels."""

import colorsys
from functools import partial

import cv2
import numpy as np

from . import procedural_labels as label


def _hsv(h, s, v):
    return np.array(colorsys.hsv_to_rgb(h % 1.0, s, v)) * 255


def _luminance(colour):
    return float(np.dot(colour, [0.3, 0.59, 0.11]))


def base_colour(rng):
    """A colour of plastic, paint or board: white, dark, cardboard or any other."""
    kind = rng.random()
    if kind < 0.18:
        return rng.uniform(215, 240) * np.array([1, rng.uniform(0.97, 1), rng.uniform(0.9, 1)])
    if kind < 0.32:
        return rng.uniform(22, 60) * rng.uniform(0.85, 1.15, 3)
    if kind < 0.40:
        return np.array([181, 143, 100]) * rng.uniform(0.85, 1.1)
    return _hsv(rng.random(), rng.uniform(0.3, 0.95), rng.uniform(0.3, 0.92))


class Palette:
    """Colours of one object: by part (main, second, metal, inside), and those of its print."""

    def __init__(self, rng):
        self.main, self.second = base_colour(rng), base_colour(rng)
        self.metal = rng.uniform(135, 190) * np.array([1, 1, rng.uniform(0.96, 1.03)])
        self.inside = self.main if rng.random() < 0.5 else rng.uniform(205, 238) * np.ones(3)
        bright = _luminance(self.main) > 120
        value = rng.uniform(0.2, 0.6) if bright else rng.uniform(0.7, 1)
        self.ground = _hsv(rng.random(), rng.uniform(0.4, 0.95), value)
        self.ink = self.contrast(rng, self.main)
        self.paper = rng.uniform(210, 240) * np.ones(3) if rng.random() < 0.5 else base_colour(rng)
        self.paper_ink = self.contrast(rng, self.paper)
        hue = rng.random()   # a picture has shades of one hue, something light or dark, and now and then another hue
        self.picture = [_hsv(hue + rng.normal(0, 0.03), rng.uniform(0.35, 0.95), rng.uniform(0.3, 0.95))
                        for _ in range(4)]
        self.picture.append(rng.uniform(200, 245) * np.ones(3))
        self.picture.append(_hsv(hue + rng.uniform(0.2, 0.8), rng.uniform(0.5, 0.9), 0.75))
        self.accents = [_hsv(rng.random(), rng.uniform(0.5, 1), rng.uniform(0.5, 1)) for _ in range(4)]

    @staticmethod
    def contrast(rng, colour):
        """An ink that can be read on a colour."""
        if _luminance(colour) > 120:
            return _hsv(rng.random(), rng.uniform(0.3, 1), rng.uniform(0.08, 0.4))
        return _hsv(rng.random(), rng.uniform(0, 0.4), rng.uniform(0.88, 1))


class Printer:
    """Composes panels. All randomness of a panel follows from the generator it is given."""

    def __init__(self, rng, palette, pixels_per_metre):
        self.palette, self.scale = palette, pixels_per_metre
        self.brand = label.word(rng)
        self.brand = [self.brand.upper(), self.brand.capitalize(), self.brand][int(rng.integers(3))]
        self.font = int(rng.choice(label.BRAND_FONTS))
        plain = self.font in (cv2.FONT_HERSHEY_SIMPLEX, cv2.FONT_HERSHEY_DUPLEX)
        self.weight = int(rng.integers(5, 12)) if plain else int(rng.integers(4, 7))
        self.slant = float(rng.choice([0.0, 0.0, 0.2]))
        self.layout = int(rng.integers(4))
        self.text_px = float(np.clip(0.0025 * pixels_per_metre, 4, 9))

    def _brand(self, image, box, colour):
        label.text(image, self.brand, box, colour, self.font, self.weight, self.slant)

    @staticmethod
    def _upright(draw, rng, image):
        """Draws a panel; on one much higher than wide, or much wider than high, possibly along it."""
        h, w = image.shape[:2]
        if h > 2.2 * w:
            turned = np.ascontiguousarray(np.rot90(image, -1))
            draw(rng, turned)
            image[:] = np.rot90(turned)
        else:
            draw(rng, image)

    def front(self, rng, image, ground=True):
        """A front panel: background of one or two colours, brand, picture, lines of text, badge."""
        h, w = image.shape[:2]
        long = max(w / h, h / w) > 2.2
        self._upright(self._wide_front if long else partial(self._tall_front, ground=ground), rng, image)

    def _wide_front(self, rng, image):
        """A long panel: a coloured end with a picture, the brand, a line of text."""
        p = self.palette
        cut = rng.uniform(0.25, 0.45)
        side = 0 if rng.random() < 0.5 else 1 - cut
        label.window(image, (side, 0, cut, 1))[:] = p.ground.astype(np.uint8)
        label.picture(rng, image, (side + 0.04, 0.1, cut - 0.08, 0.8), p.picture, str(rng.choice(["ellipse", "plate"])))
        rest = 0.03 + (cut if side == 0 else 0)
        self._brand(image, (rest, 0.14, 0.94 - cut, 0.48), p.ink)
        label.text(image, str(rng.choice(label.NOUNS)), (rest, 0.7, 0.6 * (0.94 - cut), 0.18), p.accents[0])

    def _tall_front(self, rng, image, ground):
        p = self.palette
        h, w = image.shape[:2]
        if ground and self.layout in (0, 1):
            self._second_colour(rng, image)
        at = rng.uniform(0.06, 0.16)
        if self.layout == 0:     # brand on a band, picture below
            label.window(image, (0, at, 1, 0.24))[:] = p.ground.astype(np.uint8)
            self._brand(image, (0.06, at + 0.04, 0.88, 0.16), p.contrast(rng, p.ground))
            label.picture(rng, image, (0.12, 0.45, 0.76, 0.36), p.picture, "plate")
        elif self.layout == 1:   # brand on an ellipse, picture over the lower part
            label.picture(rng, image, (0, 0.55, 1, 0.45), p.picture, "plate")
            label.ellipse(image, (0.05, 0.14, 0.9, 0.38), p.accents[1], p.accents[2])
            self._brand(image, (0.15, 0.24, 0.7, 0.18), p.contrast(rng, p.accents[1]))
        elif self.layout == 2:   # a large round picture, brand above, stripes
            label.stripes(rng, image, (0, 0.88, 1, 0.1), [p.ground, p.accents[0], p.accents[1]])
            self._brand(image, (0.06, 0.08, 0.88, 0.2), p.ink)
            label.picture(rng, image, (0.2, 0.36, 0.6, 0.6 * w / h if w < h else 0.5), p.picture)
        else:                    # text above all
            self._brand(image, (0.06, 0.12, 0.88, 0.22), p.ink)
            label.stripes(rng, image, (0.06, 0.38, 0.88, 0.05), [p.accents[0], p.ground])
            for k in range(3):
                label.text(image, str(rng.choice(label.NOUNS)), (0.1, 0.48 + 0.11 * k, 0.8, 0.075), p.ink)
        label.text(image, str(rng.choice(label.NOUNS)), (0.1, 0.34 if self.layout == 0 else 0.03, 0.5, 0.07),
                   p.accents[3])
        label.text(image, f"{int(rng.integers(2, 99)) * 10} g", (0.66, 0.9, 0.3, 0.06), p.ink)
        if rng.random() < 0.4:
            label.star(rng, image, (0.68, 0.3, 0.3, 0.22), p.accents[2], p.contrast(rng, p.accents[2]))

    def _second_colour(self, rng, image):
        """Parts the background in two: level, sloping or bent."""
        h, w = image.shape[:2]
        a, b = rng.uniform(0.45, 0.75), rng.uniform(0.45, 0.75)
        x = np.linspace(0, 1, 30)
        y = a + (b - a) * x + rng.choice([0.0, rng.uniform(-0.15, 0.15)]) * np.sin(np.pi * x)
        points = np.concatenate([np.stack([x * w, y * h], 1), [[w, h], [0, h]]])
        cv2.fillPoly(image, [np.round(points * 16).astype(np.int32)], [float(v) for v in self.palette.ground],
                     cv2.LINE_AA, 4)

    def back(self, rng, image):
        """Small print: brand, paragraphs, nutrition table, barcode."""
        self._upright(self._back, rng, image)

    def _back(self, rng, image):
        p = self.palette
        if image.shape[1] > 2.2 * image.shape[0]:
            boxes = [(0.03, 0.1, 0.25, 0.4), (0.03, 0.55, 0.25, 0.4), (0.32, 0.08, 0.36, 0.84),
                     (0.72, 0.15, 0.24, 0.7)]
        else:
            boxes = [(0.1, 0.04, 0.8, 0.14), (0.08, 0.22, 0.84, 0.26), (0.08, 0.52, 0.5, 0.42),
                     (0.62, 0.66, 0.32, 0.22)]
        self._brand(image, boxes[0], p.ink)
        label.lines(rng, image, boxes[1], p.ink, self.text_px)
        label.nutrition_table(rng, image, boxes[2], (20, 20, 20), (240, 240, 235))
        label.barcode(rng, image, boxes[3])

    def side(self, rng, image):
        """A narrow side: a coloured edge, the brand, text."""
        self._upright(self._side, rng, image)

    def _side(self, rng, image):
        p = self.palette
        wide = image.shape[1] > 1.4 * image.shape[0]
        if rng.random() < 0.6:
            band = rng.uniform(0.1, 0.3)
            label.window(image, (0, 1 - band, 1, band))[:] = p.ground.astype(np.uint8)
        self._brand(image, (0.05, 0.1, 0.4, 0.4) if wide else (0.08, 0.06, 0.84, 0.16), p.ink)
        if rng.random() < 0.5:
            label.lines(rng, image, (0.5, 0.12, 0.44, 0.5) if wide else (0.1, 0.28, 0.8, 0.38), p.ink, self.text_px)
        else:
            label.picture(rng, image, (0.55, 0.1, 0.35, 0.8) if wide else (0.15, 0.3, 0.7, 0.3), p.picture)

    def end(self, rng, image):
        """Top or bottom: the brand, perhaps in a stripe."""
        if rng.random() < 0.4:
            label.window(image, (0, 0.2, 1, 0.6))[:] = self.palette.ground.astype(np.uint8)
            self._brand(image, (0.15, 0.3, 0.7, 0.4), self.palette.contrast(rng, self.palette.ground))
        else:
            self._brand(image, (0.15, 0.25, 0.7, 0.5), self.palette.ink)

    def small_print(self, rng, image):
        """A barcode and a few lines in a corner: the only difference of two sides that are otherwise alike."""
        label.barcode(rng, image, (0.66, 0.76, 0.3, 0.2))
        area = label.window(image, (0.04, 0.8, 0.56, 0.16))
        area[:] = self.palette.paper.astype(np.uint8)
        label.lines(rng, area, (0.03, 0.05, 0.94, 0.9), self.palette.paper_ink, self.text_px)

    def strip(self, rng, image):
        """A tool's face: the brand along it and a few signs."""
        self._upright(self._strip, rng, image)

    def _strip(self, rng, image):
        p = self.palette
        x = rng.uniform(0.1, 0.35)
        if rng.random() < 0.5:
            label.window(image, (x - 0.05, 0, 0.45, 1))[:] = p.ground.astype(np.uint8)
            self._brand(image, (x, 0.34, 0.35, 0.32), p.contrast(rng, p.ground))
        else:
            self._brand(image, (x, 0.34, 0.35, 0.32), p.ink)
        label.text(image, f"{int(rng.integers(4, 60))} mm", (x + 0.45, 0.4, 0.12, 0.2), p.accents[0])

    def keys(self, _, image):
        """A remote control's keys in rows."""
        h, w = image.shape[:2]
        columns, rows = max(4, round(w / max(h, 1) * 3.0)), 3
        for k in range(columns * rows):
            colour = self.palette.accents[k % 4] if k // rows == columns - 1 else self.palette.ink
            x, y = (k // rows + 0.5) / columns, (k % rows + 0.5) / rows
            label.ellipse(image, (x - 0.36 / columns, y - 0.3 / rows, 0.72 / columns, 0.6 / rows), colour)

    def wrap(self, rng, image):
        """A can's label: bands all round, a front and, opposite, a second one or the small print."""
        p = self.palette
        for y in (0.0, 0.92):
            if rng.random() < 0.5:
                label.stripes(rng, image, (0, y, 1, 0.08), [p.ground, p.accents[0], p.accents[1]])
        seed = int(rng.integers(1 << 30))
        self.front(np.random.default_rng(seed), label.window(image, (0.03, 0.08, 0.38, 0.84)), ground=False)
        if rng.random() < 0.4:
            self.front(np.random.default_rng(seed), label.window(image, (0.53, 0.08, 0.38, 0.84)), ground=False)
            label.barcode(rng, image, (0.925, 0.55, 0.055, 0.3))
        else:
            self.back(rng, label.window(image, (0.46, 0.1, 0.3, 0.8)))
            self.side(rng, label.window(image, (0.78, 0.1, 0.19, 0.8)))

    def patch(self, rng, image):
        """A small print in front on what is plain else."""
        h = rng.uniform(0.3, 0.7)
        self.front(rng, label.window(image, (0.6, rng.uniform(0.05, 0.95 - h), 0.3, h)), ground=False)

    def bottle(self, rng, image):
        """A bottle's label: of paper all round, a patch in front and one behind, or print on the bottle itself."""
        p = self.palette
        low, high = rng.uniform(0.05, 0.25), rng.uniform(0.75, 0.95)
        kind = int(rng.integers(3))
        if kind == 0:
            area = label.window(image, (0, 1 - high, 1, high - low))
            area[:] = p.paper.astype(np.uint8)
            self._on_paper(self.wrap, rng, area)
            return
        for x, draw in ((0.58, self.front), (0.08, self.back)):
            area = label.window(image, (x, 1 - high, 0.34, high - low))
            if kind == 1:
                area[:] = p.paper.astype(np.uint8)
                self._on_paper(draw, rng, area)
            else:
                draw(rng, area)

    def _on_paper(self, draw, rng, area):
        """Draws with an ink that can be read on the label's paper."""
        p = self.palette
        p.ink, ink = p.paper_ink, p.ink
        draw(rng, area)
        p.ink = ink

    def wrap_loose(self, rng, image):
        """A mug's decoration: a picture on one side or on both, rings, dots, or a word."""
        p = self.palette
        kind = int(rng.integers(5))
        if kind < 2:
            shape = str(rng.choice(["ellipse", "plate"]))
            seed = int(rng.integers(1 << 30))
            for x in (0.15, 0.6)[:int(rng.integers(1, 3))]:
                label.picture(np.random.default_rng(seed), image, (x, 0.2, 0.25, 0.6), p.picture, shape)
            self._brand(image, (0.42, 0.35, 0.16, 0.3), p.ink)
        elif kind == 2:
            label.stripes(rng, image, (0, rng.uniform(0.1, 0.4), 1, rng.uniform(0.2, 0.5)), [p.ground, *p.accents[:2]])
        elif kind == 3:
            columns, rows = int(rng.integers(7, 13)), int(rng.integers(3, 6))
            for k in range(columns * rows):
                x, y = (k % columns + 0.5 * (k // columns % 2) + 0.25) / (columns + 0.5), (k // columns + 0.5) / rows
                label.ellipse(image, (x - 0.25 / columns, y - 0.25 / rows, 0.5 / columns, 0.5 / rows),
                              p.accents[int(rng.integers(3))])
        else:
            self._brand(image, (0.54, 0.3, 0.42, 0.4), p.ink)
            label.stripes(rng, image, (0, 0.03, 1, 0.07), [p.accents[0], p.ground])
