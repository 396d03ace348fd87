"""Reference timings for `npm run bench`: the same work in Python on the same machine, printed as one JSON line.

    python export/bench_reference.py --wav song.wav --model public/models/light.onnx --runs 5
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from pathlib import Path

import numpy as np


def median_seconds(work, runs: int) -> float:
    """Median wall time of `work()` over `runs` calls, after one call that warms caches."""
    work()
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def librosa_seconds(wav: Path, runs: int) -> float:
    """Seconds in which librosa does our extractor's work: resample, chroma (CENS), onset strength, beat tracking."""
    import librosa

    native, rate = librosa.load(wav, sr=None, mono=True)

    def work() -> None:
        song = librosa.resample(native, orig_sr=rate, target_sr=22050)
        onset = librosa.onset.onset_strength(y=song, sr=22050, hop_length=512)
        librosa.beat.beat_track(onset_envelope=onset, sr=22050, hop_length=512)
        librosa.feature.chroma_cens(C=np.abs(librosa.feature.chroma_stft(y=song, sr=22050, hop_length=512)), sr=22050)

    return median_seconds(work, runs)


def model_seconds(model: Path, seed_frames: int, music_frames: int, threads: int, runs: int) -> float:
    """Seconds that native onnxruntime takes for one window on `threads` threads."""
    import onnxruntime as ort

    options = ort.SessionOptions()
    options.intra_op_num_threads = threads
    session = ort.InferenceSession(str(model), options, providers=["CPUExecutionProvider"])
    rng = np.random.default_rng(0)
    feeds = {
        "music": rng.random((1, music_frames, 15), dtype=np.float32),
        "seed": rng.standard_normal((1, seed_frames, 147)).astype(np.float32) * 0.3,
        "key_poses": rng.standard_normal((1, music_frames, 144)).astype(np.float32) * 0.3,
        "key_mask": np.zeros((1, music_frames), np.float32),
        "to_previous": np.full((1, music_frames), -1, np.float32),
        "to_next": np.full((1, music_frames), -1, np.float32),
    }
    return median_seconds(lambda: session.run(None, feeds), runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wav", type=Path, required=True)
    parser.add_argument("--model", type=Path, required=True)
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    spec = json.loads((Path(__file__).parent.parent / "web/core/spec.json").read_text())["model"]
    latency = {
        str(threads): model_seconds(arguments.model, spec["seedFrames"], spec["musicFrames"], threads, arguments.runs * 2)
        for threads in (1, 2)
    }
    print(json.dumps({"librosa_seconds": librosa_seconds(arguments.wav, 3), "model_seconds": latency}))


if __name__ == "__main__":
    main()
