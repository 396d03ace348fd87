"""Compares our music features with librosa's, an independent implementation, and prints Markdown tables.

    python export/compare_features.py --songs <folder> [--scores <folder>] [--reference export/reference_beats]

`--songs`: recordings (anything ffmpeg reads). `--scores`: folder written by export/scores.py (known beats).
Ours comes from `npx tsx export/features.ts`, the code that runs in the browser. Columns:

- chroma: cosine of the 12 numbers frame by frame, median over the song's sounding frames. `cens`: librosa.feature.chroma_cens as
  AIST++'s feature script computes it (30720 Hz, hop 512 = 60 per second, smoothing over 41 frames = 0.68 s), pairs averaged to
  30 per second. `cens 22k`: the same at 22050 Hz, hop 512, library defaults, interpolated to 30. `stft`: librosa.feature.chroma_stft, hop 735
  smoothed and normalised like ours.
- onset: Pearson correlation with librosa.onset.onset_strength at 30 per second (22050 Hz, hop 735), and with the default hop 512
  interpolated to 30.
- beat F: F-measure, window +-70 ms, against known beats, ours and librosa.beat.beat_track's (same rates).
- downbeat: share of true downbeats found within +-70 ms and of ours that are true, as F-measure; right when F >= 0.9.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import time
import warnings
from pathlib import Path

import librosa
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
FPS = 30
RATE = 22050
HOP = 735


def f_measure(reference: np.ndarray, found: np.ndarray, window: float = 0.07) -> float:
    """F-measure of event times: each reference event is matched to at most one found event within +-window seconds."""
    if len(reference) == 0 or len(found) == 0:
        return float(len(reference) == len(found))
    hits, at = 0, 0
    for time_ in reference:
        while at < len(found) and found[at] < time_ - window:
            at += 1
        if at < len(found) and found[at] <= time_ + window:
            hits += 1
            at += 1
    return 2 * hits / (len(reference) + len(found))


def cosine(a: np.ndarray, b: np.ndarray) -> float:
    """Median over frames of the cosine; frames where either is silent are left out."""
    n = min(len(a), len(b))
    a, b = a[:n], b[:n]
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    keep = lengths > 1e-6
    return float(np.median((a * b).sum(1)[keep] / lengths[keep]))


def correlation(a: np.ndarray, b: np.ndarray) -> float:
    n = min(len(a), len(b))
    return float(np.corrcoef(a[:n], b[:n])[0, 1])


def at_fps(values: np.ndarray, rate: float, frames: int) -> np.ndarray:
    """Rows at `rate` per second, linearly interpolated to FPS."""
    times = np.arange(frames) / FPS
    known = np.arange(len(values)) / rate
    values = values if values.ndim == 2 else values[:, None]
    out = np.stack([np.interp(times, known, column) for column in values.T], 1)
    return out if out.shape[1] > 1 else out[:, 0]


def smooth_rows(values: np.ndarray, length: int = 21) -> np.ndarray:
    window = np.hanning(length + 2)[1:-1]
    return np.stack([np.convolve(column, window / window.sum(), "same") for column in values.T], 1)


def ours(paths: list[Path]) -> dict[str, dict]:
    """Runs the Node script over wav files."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npx", "tsx", "export/features.ts", "--out", folder, *map(str, paths)], cwd=ROOT, check=True,
                       capture_output=True)
        result = {}
        for path in paths:
            info = json.loads((Path(folder) / f"{path.stem}.json").read_text())
            data = np.fromfile(Path(folder) / f"{path.stem}.f32", "<f4").reshape(info["frames"], -1)
            result[path.stem] = {**info, "data": data}
        return result


def librosa_features(path: Path, frames: int) -> dict:
    """The same things by librosa."""
    y, _ = librosa.load(path, sr=RATE, mono=True)
    fine, _ = librosa.load(path, sr=60 * 512, mono=True)
    cens = librosa.feature.chroma_cens(y=fine, sr=60 * 512, hop_length=512).T
    cens = cens[: len(cens) // 2 * 2].reshape(-1, 2, 12).mean(1)
    stft = librosa.feature.chroma_stft(y=y, sr=RATE, hop_length=HOP).T
    _, beats = librosa.beat.beat_track(y=y, sr=RATE, units="time")
    return {
        "cens": cens,
        "cens22": at_fps(librosa.feature.chroma_cens(y=y, sr=RATE).T, RATE / 512, frames),
        "stft": smooth_rows(stft),
        "onset": librosa.onset.onset_strength(y=y, sr=RATE, hop_length=HOP),
        "onset512": at_fps(librosa.onset.onset_strength(y=y, sr=RATE), RATE / 512, frames),
        "beats": np.asarray(beats),
    }


def cached(path: Path, frames: int, cache: Path | None) -> dict:
    """librosa's features, kept in a folder between runs: they take far longer than ours."""
    store = cache / f"{path.stem}.npz" if cache else None
    if store and store.exists():
        return dict(np.load(store))
    found = librosa_features(path, frames)
    if store:
        store.parent.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(store, **found)
    return found


def compare(path: Path, mine: dict, theirs: dict, truth: dict | None) -> dict:
    """All figures of one song."""
    chroma, onset = mine["data"][:, :12], mine["data"][:, 14]
    row = {
        "cens": cosine(chroma, theirs["cens"]),
        "cens22": cosine(chroma, theirs["cens22"]),
        "stft": cosine(chroma, theirs["stft"]),
        "onset": correlation(onset, theirs["onset"]),
        "onset512": correlation(onset, theirs["onset512"]),
        "tempo": mine["tempo"],
        "meter": mine["beatsPerBar"],
        "agree": f_measure(theirs["beats"], np.array(mine["beats"])),
    }
    if truth:
        beats = np.array(truth["beats"])
        row["true_tempo"] = truth.get("tempo")
        row["f_ours"] = f_measure(beats, np.array(mine["beats"]))
        row["f_librosa"] = f_measure(beats, theirs["beats"])
        if truth.get("downbeats"):
            row["f_down"] = f_measure(np.array(truth["downbeats"]), np.array(mine["downbeats"]))
        row["kind"] = truth.get("kind", "song")
        row["steady"] = truth.get("steady", False)
    return row


def to_wav(paths: list[Path], folder: Path) -> list[Path]:
    out = []
    for path in paths:
        target = folder / f"{path.stem}.wav"
        subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", "-i", str(path), str(target)], check=True)
        out.append(target)
    return out


def number(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"


def table(rows: dict[str, dict]) -> None:
    print("| song | chroma cens | cens 22k | stft | onset | onset 512 | BPM (true) | meter | beat F ours | librosa | downbeat F |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name, r in rows.items():
        true = f" ({r['true_tempo']:.0f})" if r.get("true_tempo") else ""
        print(
            f"| {name} | {number(r['cens'])} | {number(r['cens22'])} | {number(r['stft'])} | {number(r['onset'])} | "
            f"{number(r['onset512'])} | {r['tempo']:.1f}{true} | {r['meter']} | {number(r.get('f_ours'))} | "
            f"{number(r.get('f_librosa'))} | {number(r.get('f_down'))} |"
        )


def summary(rows: dict[str, dict]) -> None:
    """Means by kind of score."""
    print("\n| kind | scores | chroma cens (median) | onset (median) | beat F ours (mean, worst) | librosa (mean) | downbeats right |")
    print("|---|---|---|---|---|---|---|")
    kinds: dict[str, list[dict]] = {}
    for r in rows.values():
        kinds.setdefault(r.get("kind", "song"), []).append(r)
        if r.get("steady"):
            kinds.setdefault("all steady", []).append(r)
    for kind, group in kinds.items():
        f = [r["f_ours"] for r in group if "f_ours" in r]
        if not f:
            continue
        down = [r["f_down"] >= 0.9 for r in group if "f_down" in r]
        print(
            f"| {kind} | {len(group)} | {np.median([r['cens'] for r in group]):.3f} | "
            f"{np.median([r['onset'] for r in group]):.3f} | {np.mean(f):.3f}, {min(f):.3f} | "
            f"{np.mean([r['f_librosa'] for r in group]):.3f} | {sum(down)} of {len(down)} |"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--songs", type=Path)
    parser.add_argument("--scores", type=Path)
    parser.add_argument("--reference", type=Path, default=ROOT / "export" / "reference_beats")
    parser.add_argument("--cache", type=Path, help="folder that keeps librosa's results between runs")
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    with tempfile.TemporaryDirectory() as folder:
        rows: dict[str, dict] = {}
        if arguments.songs:
            files = [p for p in sorted(arguments.songs.iterdir()) if p.suffix in {".mp3", ".ogg", ".wav", ".flac", ".m4a"}]
            wavs = to_wav(files, Path(folder))
            mine = ours(wavs)
            for wav in wavs:
                reference = arguments.reference / f"{wav.stem}.json"
                truth = json.loads(reference.read_text()) if reference.exists() else None
                rows[wav.stem] = compare(wav, mine[wav.stem], cached(wav, mine[wav.stem]["frames"], arguments.cache), truth)
            table(rows)
            print()
        if arguments.scores:
            wavs = sorted(arguments.scores.glob("*.wav"))
            begun = time.time()
            mine = ours(wavs)
            rows = {}
            for wav in wavs:
                truth = json.loads(wav.with_suffix(".json").read_text())
                rows[wav.stem] = compare(wav, mine[wav.stem], cached(wav, mine[wav.stem]["frames"], arguments.cache), truth)
            table(rows)
            summary(rows)
            print(f"\n{time.time() - begun:.0f} s")


if __name__ == "__main__":
    main()
