"""A quick look at poses: shaded capsule figures on contact sheets (needs Pillow; for authors, not for the build)."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw

LEFT, RIGHT, TRUNK, SKIN = (96, 165, 250), (251, 133, 110), (214, 211, 224), (240, 214, 190)
#: joint, joint, radius at each end, colour
CAPSULES = (
    (0, 3, 0.105, 0.1, TRUNK), (3, 6, 0.1, 0.105, TRUNK), (6, 9, 0.105, 0.11, TRUNK), (9, 12, 0.1, 0.055, TRUNK),
    (1, 2, 0.085, 0.085, TRUNK), (16, 17, 0.06, 0.06, TRUNK), (12, 15, 0.045, 0.045, SKIN),
    (1, 4, 0.08, 0.055, LEFT), (4, 7, 0.055, 0.038, LEFT), (2, 5, 0.08, 0.055, RIGHT), (5, 8, 0.055, 0.038, RIGHT),
    (16, 18, 0.05, 0.04, LEFT), (18, 20, 0.04, 0.03, LEFT), (20, 22, 0.036, 0.03, LEFT),
    (17, 19, 0.05, 0.04, RIGHT), (19, 21, 0.04, 0.03, RIGHT), (21, 23, 0.036, 0.03, RIGHT),
)  # fmt: skip


def _view(yaw_degrees: float) -> np.ndarray:
    a, tilt = np.radians(yaw_degrees), np.radians(8)
    turn = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    look = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    return look @ turn


def draw(points: np.ndarray, world: np.ndarray, yaw: float, size=(210, 290), scale=125, centre=None) -> Image.Image:
    """One figure seen from `yaw` degrees (0 = from the front, i.e. camera at +Z)."""
    ss = 2
    image = Image.new("RGB", (size[0] * ss, size[1] * ss), (26, 27, 36))
    pen = ImageDraw.Draw(image)
    view = _view(yaw)
    middle = np.array([points[0][0], 0, points[0][2]]) if centre is None else np.asarray(centre)

    def project(p):
        v = view @ (p - middle)
        return np.array([size[0] * ss / 2 + v[0] * scale * ss, size[1] * ss * 0.88 - v[1] * scale * ss]), v[2]

    for i in np.arange(-0.75, 0.76, 0.25):
        for a, b in (((i, 0, -0.75), (i, 0, 0.75)), ((-0.75, 0, i), (0.75, 0, i))):
            pen.line([tuple(project(middle + np.array(a))[0]), tuple(project(middle + np.array(b))[0])], (46, 48, 62), 2)
    balls = []

    def capsule(a, b, ra, rb, colour):
        for t in np.linspace(0, 1, max(2, int(np.linalg.norm(b - a) / 0.012))):
            p, depth = project(a + (b - a) * t)
            balls.append((depth, p, (ra + (rb - ra) * t) * scale * ss, colour))

    for a, b, ra, rb, colour in CAPSULES:
        capsule(points[a], points[b], ra, rb, colour)
    for side, colour in ((0, LEFT), (1, RIGHT)):
        ankle, toe = (7, 10) if side == 0 else (8, 11)
        heel = points[ankle] + world[ankle] @ np.array([0, -0.05, -0.05])
        tip = points[toe] + world[toe] @ np.array([0.005, -0.0, 0.06])
        capsule(heel, points[toe], 0.034, 0.032, colour)
        capsule(points[toe], tip, 0.03, 0.022, colour)
        capsule(points[ankle], points[toe], 0.036, 0.03, colour)
        hand, out = (20, 1.0) if side == 0 else (21, -1.0)
        # thumb: shows which way the palm looks
        capsule(points[hand] + world[hand] @ np.array([0.03 * out, 0, 0.02]),
                points[hand] + world[hand] @ np.array([0.06 * out, 0, 0.055]), 0.014, 0.012, SKIN)
    head = points[15] + world[15] @ np.array([0, 0.06, 0.01])
    capsule(head, head + world[15] @ np.array([0, 0.06, 0]), 0.1, 0.09, SKIN)
    capsule(head + world[15] @ np.array([0, 0.02, 0.09]), head + world[15] @ np.array([0, 0.01, 0.13]), 0.02, 0.016, (90, 60, 40))
    balls.sort(key=lambda item: item[0])
    low, high = balls[0][0], balls[-1][0]
    for depth, p, r, colour in balls:
        light = 0.55 + 0.45 * (depth - low) / (high - low + 1e-6)
        shade = tuple(int(c * light) for c in colour)
        edge = tuple(int(c * light * 0.55) for c in colour)
        pen.ellipse([p[0] - r, p[1] - r, p[0] + r, p[1] + r], fill=edge)
        r2, o = r * 0.86, r * 0.1
        pen.ellipse([p[0] - r2 - o, p[1] - r2 - o, p[0] + r2 - o, p[1] + r2 - o], fill=shade)
    return image.resize(size, Image.LANCZOS)


def sheet(items, columns: int, path: str) -> None:
    """Writes labelled pictures: items = [(label, [images])]."""
    width = sum(i.width for i in items[0][1]) + 8
    height = items[0][1][0].height + 18
    rows = (len(items) + columns - 1) // columns
    out = Image.new("RGB", (width * columns, height * rows), (12, 12, 18))
    pen = ImageDraw.Draw(out)
    for index, (label, images) in enumerate(items):
        x, y = index % columns * width, index // columns * height
        pen.text((x + 6, y + 3), label, fill=(255, 255, 255))
        for image in images:
            out.paste(image, (x, y + 18))
            x += image.width
    out.save(path)
