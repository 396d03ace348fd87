"""Gives shipped models the hash of a spec.json that grew without touching what they were trained on:

    python export/restamp.py --models public/models

Only new sections may have been added: what a model uses (fps, skeleton, features, model) must be as it was. The weights and the numbers
of the golden windows stay as they are. Then run `python export/golden.py --out tests/golden`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path

import onnx

from spec import spec_hash


def restamp_model(path: Path) -> str:
    """Writes the present hash into an ONNX file's metadata -> the hash it had."""
    proto = onnx.load(path)
    before = ""
    for entry in proto.metadata_props:
        if entry.key == "specHash":
            before, entry.value = entry.value, spec_hash()
    if not before:
        raise ValueError(f"{path} carries no spec hash: it is not a model of this project")
    path.write_bytes(proto.SerializeToString())
    return before


def restamp_json(path: Path, model: Path | None = None) -> None:
    """Writes the present hash into a JSON file beside a model, and the model's size and digest where it lists them."""
    content = json.loads(path.read_text(encoding="utf-8"))
    content["specHash"] = spec_hash()
    if model and "sha256" in content:
        data = model.read_bytes()
        content |= {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, required=True, help="folder with the models and the JSON files beside them")
    args = parser.parse_args()
    for path in sorted(args.models.glob("*.onnx")):
        print(f"{path.name}: {restamp_model(path)[:12]} -> {spec_hash()[:12]}")
    for path in sorted(args.models.glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        if "specHash" in content:
            restamp_json(path, args.models / content["file"] if "file" in content else None)


if __name__ == "__main__":
    main()
