"""The contract that Python and TypeScript share: web/core/spec.json, read once and never repeated here."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

SPEC_PATH = Path(__file__).resolve().parent.parent / "web" / "core" / "spec.json"
SPEC: dict = json.loads(SPEC_PATH.read_text(encoding="utf-8"))

FPS: int = SPEC["fps"]
JOINTS: list[str] = SPEC["skeleton"]["joints"]
PARENTS: list[int] = SPEC["skeleton"]["parents"]
OFFSETS: list[list[float]] = SPEC["skeleton"]["offsets"]
TOE_HEIGHT: float = SPEC["skeleton"]["toeHeight"]
FEET: dict[str, dict[str, int]] = SPEC["skeleton"]["feet"]
TOES: list[int] = [FEET["left"]["toe"], FEET["right"]["toe"]]
JOINT_COUNT = len(JOINTS)

FEATURE_NAMES: list[str] = SPEC["features"]["names"]
FEATURE_COUNT = len(FEATURE_NAMES)
BEAT = FEATURE_NAMES.index("beat")
DOWNBEAT = FEATURE_NAMES.index("downbeat")
ONSET = FEATURE_NAMES.index("onset")

SEED_FRAMES: int = SPEC["model"]["seedFrames"]
MUSIC_FRAMES: int = SPEC["model"]["musicFrames"]
MAX_FRAMES: int = SPEC["model"]["maxFrames"]
ROTATION_SIZE: int = SPEC["model"]["rotationSize"]
MOTION_SIZE: int = SPEC["model"]["motionSize"]


def spec_hash() -> str:
    """SHA-256 (hex) of the canonical JSON of the spec: sorted keys, no spaces. A model made for another spec is refused."""
    canonical = json.dumps(SPEC, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode()).hexdigest()
