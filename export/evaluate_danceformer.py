"""Measures DanceFormer's shipped networks on the validation clips (paper B's Table 4 on our data, and what else must hold):

    python export/evaluate_danceformer.py --data DATA --features FEATURES15 --song-features FEATURES53 --models public/models --out export/results/danceformer

Writes OUT.json and OUT.md. Dances are cut from the first to the last beat inside a clip; key poses stand on every beat (nearest frame).
`from real poses`: the real poses on the beats are given; errors are taken on the frames between them, root-aligned, and the path over the
floor is the real one but for `curves` in the path error. `from stage 1`: poses are suggested from nothing, style "any", at --temperature,
and joined by each method; such dances have no true frames, so only distributions, beats and variance are compared.
BC: paper B prints no sigma; ours is 0.05 s (3 frames at 60 per second, as in the score it is derived from). Motion beats are local minima
of the mean joint speed. PVar is over the dances' first pieces of at least 6 s.
If OUT-fit.json (curve_fit.py) and OUT-ablations.json (ablate_danceformer.py) are there, their tables are put into OUT.md too.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import torch
from torch import Tensor

from baselines import NearestNeighbour, cubic_rotations, slerp_rotations, with_path
from dance_metrics import pose_vectors
from danceformer_data import Dance, load_dances, split_dances
from danceformer_run import Networks, draw_curves, frames_of, smoothness_at_keys, suggest_poses
from data import load_clips
from evaluation.dances import Task, cut
from evaluation.shipped import Order, Song, make_dances
from evaluation.tables import grid as table_of
from evaluation.tables import number
from evaluation.tally import Piece, Tally, measure, row
from metrics import matrices_of
from rotation import matrix_to_quaternion
from spec import FPS, MUSIC_FRAMES, ROTATION_SIZE, SEED_FRAMES
from styles import style_accuracy

TOP = Path(__file__).resolve().parent.parent
COLUMNS = ("position_cm", "rotation_deg", "NPSS", "PFD", "VFD", "PVar", "BC", "hit3", "speed_ratio", "jerk_ratio", "foot_skate")
TITLES = ("position, cm", "rotation, deg", "NPSS", "PFD, cm2", "VFD, m2/s2", "PVar, cm2", "BC", "beat hit 3", "speed / real", "jerk / real", "foot skate, m/s")


def dance_task(dance: Dance) -> tuple[Task, Tensor] | None:
    """(task from the first to the last beat inside the clip, numbers of its beats in the song); None with fewer than 6 beats."""
    inside = torch.nonzero((dance.beats >= 0) & (dance.beats <= dance.clip.frames - 1))[:, 0]
    if len(inside) < 6:
        return None
    at = dance.beats[inside].round().long()
    first, last = int(at[0]), int(at[-1])
    keys = at - first
    real = dance.clip.motion[first : last + 1].clone()
    real[:, ROTATION_SIZE] -= real[0, ROTATION_SIZE].clone()
    real[:, ROTATION_SIZE + 2] -= real[0, ROTATION_SIZE + 2].clone()
    between = dance.clip.valid[first : last + 1].all(-1).clone()
    between[keys] = False
    pieces, start = [], 0
    while start < len(keys) - 1:
        end = start + 1
        while end + 1 < len(keys) and int(keys[end + 1] - keys[start]) < MUSIC_FRAMES:
            end += 1
        pieces.append((int(keys[start]), int(keys[end] - keys[start]) + 1))
        start = end
    seed = dance.clip.motion[max(0, first - SEED_FRAMES) : first]
    music = dance.clip.music[first : last + 1]
    return Task(dance.clip, 0, seed, real, music, keys, between, dance.beats - first, pieces), inside


def shifted(dance: Dance, task: Task) -> Dance:
    """The dance with its music told from the task's first frame on."""
    first = dance.clip.frames  # found from the beats: the task's beats are the dance's, less its first frame
    first = round(float((dance.beats - task.beats)[0]))
    return Dance(dance.clip, dance.motion, dance.valid, dance.style, task.beats, dance.music, dance.frames, dance.start + first)


def joined(poses: Tensor, task: Task, dance: Dance, networks: Networks, nearest: NearestNeighbour | None) -> dict[str, Tensor]:
    """Dances [N, 147] through key poses [M, 147] by every method that needs no page; the path over the floor is the curves' own."""
    keys = task.keys
    curves = draw_curves(networks.curves, poses, keys, shifted(dance, task))
    made = {"curves": frames_of(curves)}
    path = made["curves"][:, ROTATION_SIZE:]
    rotations = matrices_of(poses)
    made["slerp"] = with_path(slerp_rotations(rotations, keys, task.frames), path)
    made["cubic"] = with_path(cubic_rotations(rotations, keys, task.frames), path)
    if nearest:
        sparse = torch.zeros(task.frames, poses.shape[1])
        sparse[:, 0:ROTATION_SIZE:6] = sparse[:, 4:ROTATION_SIZE:6] = 1
        sparse[keys] = poses
        made["nearest neighbour"] = with_path(nearest.rotations(sparse, keys), path)
    return made


def page_dances(model: Path, tasks: list[Task], poses: list[Tensor]) -> list[Tensor]:
    """The light model's dances through key poses, by the page's own code, from the page's starting clip."""
    orders = []
    for task, keys in zip(tasks, poses):
        song = Song(task.music, task.beats, task.clip.downbeats)
        orders.append(Order(song, {"light": {"keyStrength": 1.0}}, None, 0, task.keys, keys))
    return [made["light"] for made in make_dances(model, orders)]


def plausibility(made: list[Tensor], real: list[Tensor], training: list[Dance]) -> dict:
    """How near suggested poses are to training frames (both mirror forms, every second frame): mean joint distance in cm."""
    pool = torch.cat([vectors[::2][dance.valid[::2]] for dance in training for vectors in dance.vectors])

    def nearest(vectors: Tensor) -> Tensor:
        found = torch.full((len(vectors),), float("inf"))
        for part in pool.split(20_000):  # joints weigh alike: root of the mean square, then near enough the mean
            found = torch.minimum(found, torch.cdist(vectors, part).min(1).values)
        return found / 23**0.5 * 100

    ours, theirs = nearest(torch.cat([pose_vectors(poses) for poses in made])), nearest(torch.cat([pose_vectors(poses) for poses in real]))
    bound = float(theirs.quantile(0.99))
    return {
        "poses": len(ours),
        "real_poses": len(theirs),
        "real_99_cm": round(bound, 2),
        "share_beyond": round(float((ours > bound).float().mean()), 4),
        "nearest_cm": {"median": round(float(ours.median()), 2), "p95": round(float(ours.quantile(0.95)), 2)},
        "real_nearest_cm": {"median": round(float(theirs.median()), 2), "p95": round(float(theirs.quantile(0.95)), 2)},
        "copies": round(float((ours < 0.5).float().mean()), 4),
    }


def limits(poses: Tensor) -> dict:
    """Joint limits by the page's table (needs Node)."""
    with tempfile.NamedTemporaryFile(suffix=".f32") as file:
        matrix_to_quaternion(matrices_of(poses.double())).flatten(1).numpy().astype("<f4").tofile(file.name)
        done = subprocess.run(["npx", "tsx", "export/limits.ts", file.name], cwd=TOP, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout.strip().splitlines()[-1])
    return {"share_of_poses_beyond_5_deg": round(found["beyond"] / found["poses"], 4), "share_of_joints": round(found["joints"], 5), "worst_deg": round(found["worst"], 1)}


def measure_all(dances: list[Dance], training: list[Dance], networks: Networks, args: argparse.Namespace) -> dict:
    """All tables."""
    nearest = NearestNeighbour([dance.clip for dance in training if dance.has_music or dance.clip.source == "tang"]) if args.nearest else None
    work = [(dance, *found) for dance in dances if (found := dance_task(dance))]
    tables: dict[str, dict[tuple[str, str], Tally]] = {"from real poses": {}, "from stage 1": {}}
    suggested, real_keys, jumps, path_error, path_count = [], [], [], 0.0, 0
    dances_of: list[dict[str, Tensor]] = []
    for number_, (dance, task, inside) in enumerate(work):
        poses = suggest_poses(networks.suggest, dance.music, inside, temperature=args.temperature, seed=number_)[0]
        suggested.append(poses)
        real_keys.append(task.real[task.keys])
        dances_of.append(joined(poses, task, dance, networks, nearest))
    if args.page:
        for made, dance in zip(dances_of, page_dances(args.models / "light.onnx", [task for _, task, _ in work], suggested)):
            made["light model"] = dance[: len(made["curves"])]
    for (dance, task, _), made in zip(work, dances_of):
        real = [Piece(piece) for piece in cut(task.real, task)]
        true_path = task.real[:, ROTATION_SIZE:]
        given = draw_curves(networks.curves, task.real[task.keys], task.keys, shifted(dance, task), roots=true_path[task.keys])
        jumps.append(smoothness_at_keys(given))
        own = frames_of(draw_curves(networks.curves, task.real[task.keys], task.keys, shifted(dance, task)))
        apart = (own[task.keys[1:], ROTATION_SIZE:] - own[task.keys[:-1], ROTATION_SIZE:]) - (true_path[task.keys[1:]] - true_path[task.keys[:-1]])
        path_error, path_count = path_error + float(apart[:, [0, 2]].norm(dim=-1).sum()), path_count + len(apart)
        rows = {name: with_path(matrices_of(motion), true_path) for name, motion in joined(task.real[task.keys], task, dance, networks, nearest).items()}
        rows["curves"] = frames_of(given)
        for table, ours in (("from real poses", rows), ("from stage 1", made)):
            for name, motion in ({"real": task.real} | ours).items():
                into = [tables[table].setdefault((group, name), Tally()) for group in (dance.clip.source, "all")]
                measure(into, task, cut(motion, task), real)
    result: dict = {"tables": {}, "clips": len(work)}
    for table, tallies in tables.items():
        groups = sorted({group for group, _ in tallies})
        result["tables"][table] = {
            group: {name: {c: v for c, v in row(tally, tallies[group, "real"]).items() if c in COLUMNS} for (of, name), tally in tallies.items() if of == group}
            for group in groups
        }
    result["plausibility"] = plausibility(suggested, real_keys, training)
    if args.page:
        result["limits"] = {"suggested": limits(torch.cat(suggested)), "real": limits(torch.cat(real_keys))}
    result["velocity_jump_at_keys"] = round(sum(jumps) / len(jumps), 4)
    result["path_error_cm_per_interval"] = round(path_error / path_count * 100, 2)
    return result


def bars(result: dict, fit: dict | None) -> list[dict]:
    """The bars, figure by figure."""
    real, stage1 = result["tables"]["from real poses"]["all"], result["tables"]["from stage 1"]["all"]
    gain = 1 - real["curves"]["position_cm"] / real["slerp"]["position_cm"]
    found = [
        ("stage 2 below SLERP between real poses on beats, position", ">= 15 %", round(gain * 100, 1), gain >= 0.15),
        ("BC of stage 1 + 2 / real", ">= 0.9", round(stage1["curves"]["BC"] / stage1["real"]["BC"], 3), stage1["curves"]["BC"] >= 0.9 * stage1["real"]["BC"]),
        ("PVar of stage 1 + 2 / real", ">= 0.7", round(stage1["curves"]["PVar"] / stage1["real"]["PVar"], 3), stage1["curves"]["PVar"] >= 0.7 * stage1["real"]["PVar"]),
        ("suggested poses farther from training poses than real ones' 99th percentile", "<= 2 %", round(result["plausibility"]["share_beyond"] * 100, 2), result["plausibility"]["share_beyond"] <= 0.02),
    ]
    if fit:
        best = [r for r in fit["rows"] if r["group"] == "all" and r["times_fewer"] >= 5]
        best = min(best, key=lambda r: r["joints_cm"]) if best else None
        if best:
            figure = f"4-knot fit with at least 5 times fewer numbers ({best['form']}, keys every {best['beats']} beats: {best['times_fewer']} times fewer), cm"
            found.insert(0, (figure, "<= 2 cm", best["joints_cm"], best["joints_cm"] <= 2))
    return [dict(zip(("figure", "bar", "value", "met"), item)) for item in found]


def markdown(result: dict, fit: dict | None, ablations: dict | None) -> str:
    """All tables as text."""
    parts = [f"# DanceFormer on {result['clips']} clips of `val`", f"    {result['command']}", __doc__.split("Writes OUT.json and OUT.md. ")[1]]
    parts.append("## Bars\n\n" + table_of(["figure", "bar", "measured", "met"], [[b["figure"], b["bar"], str(b["value"]), "yes" if b["met"] else "no"] for b in result["bars"]]))
    for name, groups in result["tables"].items():
        lines = [
            [group, dance, *(number(values.get(column, float("nan"))) if not (name == "from stage 1" and column in ("position_cm", "rotation_deg") and dance != "real") else "-" for column in COLUMNS)]
            for group, dances in groups.items()
            for dance, values in dances.items()
        ]
        parts.append(f"## {name[0].upper()}{name[1:]}\n\n" + table_of(["clips", "dance", *TITLES], lines))
    p = result["plausibility"]
    parts.append(
        "## Suggested poses\n\n"
        f"{p['poses']} poses. Nearest training frame: median {p['nearest_cm']['median']} cm, 95th percentile {p['nearest_cm']['p95']} cm "
        f"(real validation poses: {p['real_nearest_cm']['median']} and {p['real_nearest_cm']['p95']} cm, 99th percentile {p['real_99_cm']} cm). "
        f"Beyond that percentile: {p['share_beyond']:.1%}. Nearer than 0.5 cm to a training frame, so copies: {p['copies']:.1%}."
    )
    if "limits" in result:
        lines = [[kind, f"{v['share_of_poses_beyond_5_deg']:.1%}", f"{v['share_of_joints']:.2%}", str(v["worst_deg"])] for kind, v in result["limits"].items()]
        parts.append(
            "Joint limits by the page's table (web/core/joint-limits-table.ts), of the network's own output:\n\n"
            + table_of(["poses", "with a joint more than 5 degrees beyond", "joints", "worst, degrees"], lines)
            + "\n\nRecorded dance leaves those ranges too; the page brings every suggested pose inside them (web/core/suggest-pose.ts)."
        )
    parts.append(
        f"Velocity jump at keys, share of the velocity there: {result['velocity_jump_at_keys']}. "
        f"Path over the floor that stage 2 finds by itself: {result['path_error_cm_per_interval']} cm off an interval."
    )
    if "styles" in result:
        s = result["styles"]
        parts.append(
            "## Does the style input do anything?\n\n"
            f"A linear classifier of rows of eight poses, trained on real training rows, names the style of held-out real rows in {s['real']:.0%} of cases, and of rows "
            f"suggested for the same songs with a style asked for in {s['suggested']:.0%}; with the style of another row asked for instead, the row is still called by its song's own "
            f"style in {s['song']:.0%}. Chance: {s['chance']:.0%}."
        )
    if fit:
        head = ["clips", "beats between keys", "form", "joints, cm", "worst joint, cm", "rotation, deg", "numbers, times fewer"]
        lines = [[r["group"], str(r["beats"]), r["form"], str(r["joints_cm"]), str(r["worst_joint_cm"]), str(r["rotation_deg"]), str(r["times_fewer"])] for r in fit["rows"]]
        parts.append("## Curves fitted to real dance\n\n    " + fit["command"] + "\n\n" + table_of(head, lines))
    if ablations:
        parts.append(ablations["markdown"])
    return "\n\n".join(parts) + "\n"


def read_json(path: Path) -> dict | None:
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--features", required=True)
    parser.add_argument("--song-features", type=Path, required=True)
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--split", choices=("val", "dev"), default="val", help="dev: training songs held out for choices")
    parser.add_argument("--temperature", type=float, default=1.0)
    parser.add_argument("--no-page", dest="page", action="store_false", help="leave out what needs Node")
    parser.add_argument("--no-nearest", dest="nearest", action="store_false", help="leave out the nearest neighbour, which takes minutes")
    parser.add_argument("--no-styles", dest="styles", action="store_false")
    parser.add_argument("--out", type=Path, required=True, help="path without extension")
    args = parser.parse_args()
    torch.set_num_threads(1)
    began = time.monotonic()
    training, development, validation = split_dances(load_dances(args.data, args.song_features, load_clips(args.data, args.features, args.cache)))
    networks = Networks.load(args.models)
    result = measure_all(validation if args.split == "val" else development, training, networks, args)
    if args.styles:
        result["styles"] = style_accuracy(networks, training, development + validation, args.temperature)
    private = {str(args.data): "DATA", args.features: "FEATURES15", str(args.song_features): "FEATURES53", args.cache: "CACHE"}
    result["command"] = " ".join(["python export/evaluate_danceformer.py", *(private.get(word, word) for word in sys.argv[1:])])
    result["seconds"] = round(time.monotonic() - began)
    fit, ablations = (read_json(args.out.with_name(f"{args.out.name}-{part}.json")) for part in ("fit", "ablations"))
    result["bars"] = bars(result, fit)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    args.out.with_suffix(".md").write_text(markdown(result, fit, ablations), encoding="utf-8")
    print(json.dumps(result["bars"], indent=1), json.dumps(result["plausibility"]), f"{result['seconds']} s", sep="\n")


if __name__ == "__main__":
    main()
