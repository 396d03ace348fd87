"""Whether the styles that stage 1 is asked for can be told apart: a linear classifier of rows of eight key poses."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from danceformer_data import Dance
from danceformer_run import Networks, suggest_poses
from dance_metrics import pose_vectors

ROW = 8


def row_features(vectors: Tensor) -> Tensor:
    """Joints of eight poses [..., 8, 69] -> mean, spread and mean step of each number [..., 207]."""
    return torch.cat([vectors.mean(-2), vectors.std(-2), (vectors[..., 1:, :] - vectors[..., :-1, :]).abs().mean(-2)], -1)


def rows_of(dance: Dance, step: int = 4) -> Tensor:
    """Rows of eight poses on the beats inside a clip [n, 8, 69]; only whole ones."""
    inside = dance.beats[(dance.beats >= 0) & (dance.beats <= dance.clip.frames - 1)].round().long()
    inside = inside[dance.valid[inside]]
    starts = range(0, len(inside) - ROW + 1, step)
    return torch.stack([dance.vectors[0][inside[s : s + ROW]] for s in starts]) if len(starts) else torch.zeros(0, ROW, 69)


def train_classifier(dances: list[Dance], styles: list[int]) -> tuple[nn.Linear, Tensor, Tensor]:
    """(classifier, mean, spread) of row features; classes are `styles` by place."""
    features, labels = [], []
    for dance in dances:
        if dance.has_music and dance.style.any() and int(dance.style.argmax()) in styles:
            rows = rows_of(dance, 2)
            if not len(rows):
                continue
            rows = row_features(rows)
            features.append(rows)
            labels += [styles.index(int(dance.style.argmax()))] * len(rows)
    x, y = torch.cat(features), torch.tensor(labels)
    mean, spread = x.mean(0), x.std(0) + 0.02
    torch.manual_seed(0)
    model = nn.Linear(x.shape[1], len(styles))
    share = torch.bincount(y, minlength=len(styles)).float()
    optimiser = torch.optim.AdamW(model.parameters(), lr=0.01, weight_decay=0.3)
    weights = 1 / share.clamp(min=1).sqrt()
    for _ in range(250):
        loss = nn.functional.cross_entropy(model((x - mean) / spread), y, weight=weights)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return model, mean, spread


def style_accuracy(networks: Networks, training: list[Dance], held: list[Dance], temperature: float) -> dict:
    """Shares named rightly: held-out real rows, suggested rows with the style asked for; and how many with a wrong style asked for are
    called by their song's own."""
    held = [dance for dance in held if dance.has_music and dance.style.any()]
    known = sorted({int(dance.style.argmax()) for dance in training if dance.has_music and dance.style.any()})
    model, mean, spread = train_classifier(training, known)
    name = lambda vectors: [known[int(c)] for c in model((row_features(vectors) - mean) / spread).argmax(-1)]  # noqa: E731
    right = {"real": [], "suggested": [], "song": []}
    rng = torch.Generator().manual_seed(0)
    for number, dance in enumerate(held):
        own = int(dance.style.argmax())
        real = rows_of(dance)
        if own in known and len(real):
            right["real"] += [style == own for style in name(real)]
        inside = torch.nonzero((dance.beats >= 0) & (dance.beats <= dance.clip.frames - 1))[:, 0][:24]
        if len(inside) < ROW:
            continue
        asked = known[int(torch.randint(0, len(known), (), generator=rng))]
        style = torch.zeros_like(dance.style)
        style[asked] = 1
        made = suggest_poses(networks.suggest, dance.music, inside, None, temperature, number, style)[0]
        rows = torch.stack([pose_vectors(made[s : s + ROW]) for s in range(0, len(made) - ROW + 1, ROW)])
        named = name(rows)
        right["suggested"] += [style_ == asked for style_ in named]
        if own != asked:
            right["song"] += [style_ == own for style_ in named]
    return {kind: round(sum(flags) / max(1, len(flags)), 3) for kind, flags in right.items()} | {"chance": round(1 / len(known), 3), "styles": len(known)}
