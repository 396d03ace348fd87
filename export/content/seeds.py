"""Authors public/library/seeds.json: looping starting clips, choreographed on beats (see clips.py).

    python export/content/seeds.py [--strip FOLDER] [--only ID]
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from choreography import choreographies
from clips import ClipSolver

OUT = Path(__file__).resolve().parents[2] / "public/library/seeds.json"
#: with 8 poses a beat a planted toe moves by less than 2 mm between two poses; with 4 by up to 15 mm
RATE = 8


def build(plan) -> tuple[dict, list]:
    """One SeedClip (see web/core/types.ts) and its solved poses."""
    solver = ClipSolver(plan)
    solver.prepare()
    count = plan.beats * RATE
    solved = [solver.sample(i / RATE) for i in range(count)]
    root = np.array([s.root for s in solved])
    root[:, [0, 2]] -= root[0, [0, 2]]
    clip = {
        "id": plan.id,
        "name": plan.name,
        "description": plan.description,
        "beats": plan.beats,
        "rate": RATE,
        "poses": [[round(float(v), 3) + 0.0 for v in s.rotations()] for s in solved],
        "root": [[round(float(v), 4) + 0.0 for v in r] for r in root],
    }
    return clip, solved


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strip", help="folder for pictures: one strip of half beats per clip")
    parser.add_argument("--only", help="draw and check this clip only; nothing is written")
    options = parser.parse_args()
    clips = []
    for plan in choreographies():
        if options.only and plan.id != options.only:
            continue
        clip, solved = build(plan)
        clips.append(clip)
        notes = sorted({w.split(" by ")[0] for s in solved for w in s.warnings})
        print(f"{plan.id:22} {plan.beats:3} beats, lowest joint {min(s.points[:, 1].min() for s in solved):.3f} m", *notes)
        if options.strip:
            draw_strip(plan, solved, Path(options.strip) / f"{plan.id}.png")
    if not options.only:
        lines = ",\n".join(json.dumps(c, separators=(",", ":")) for c in clips)
        OUT.write_text('{"version":1,"clips":[\n' + lines + "\n]}\n")
        print(len(clips), "clips,", OUT.stat().st_size, "bytes")


def draw_strip(plan, solved, path: Path) -> None:
    """Half beats side by side, from the front and from the side, camera fixed."""
    from render import draw, sheet

    step = RATE // 2 if plan.beats <= 8 else RATE
    middle = np.mean([s.root for s in solved], 0) * [1, 0, 1]
    items = []
    for i in range(0, len(solved), step):
        s = solved[i]
        pictures = [draw(s.points, s.world, a, size=(130, 190), scale=80, centre=middle) for a in (-12, -75)]
        items.append((f"{plan.id} {i / RATE:g}", pictures))
    sheet(items, 8 if plan.beats != 12 else 6, str(path))


if __name__ == "__main__":
    main()
