"""Small songs with known beats: writes MIDI scores and renders them with FluidSynth, to test beat tracking.

    python export/scores.py --out <folder> [--soundfont /usr/share/sounds/sf2/FluidR3_GM.sf2]

For each score: NAME.mid, NAME.wav and NAME.json {beats, downbeats (seconds), tempo, beatsPerBar, steady, kind}.
Every note is made by the rules below from a seeded random generator, so two runs give the same songs.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import mido

TICKS = 480
DRUMS = 9
KICK, RIM, SNARE, CLAP, HAT, OPEN_HAT, RIDE, COWBELL, CONGA, SHAKER, TRIANGLE = 36, 37, 38, 39, 42, 46, 51, 56, 63, 70, 81
# Chords as semitones above the key: I V vi IV, i VI III VII, ii V I vi, I IV I V.
PROGRESSIONS = [
    [(0, 4, 7), (7, 11, 14), (9, 12, 16), (5, 9, 12)],
    [(0, 3, 7), (8, 12, 15), (3, 7, 10), (10, 14, 17)],
    [(2, 5, 9), (7, 11, 14), (0, 4, 7), (9, 12, 16)],
    [(0, 4, 7), (5, 9, 12), (0, 4, 7), (7, 11, 14)],
]


@dataclass
class Score:
    """Notes on a beat grid; positions and lengths in beats, velocities 1-127."""

    rng: random.Random
    notes: list[tuple[int, float, float, int, int]] = field(default_factory=list)
    programs: dict[int, int] = field(default_factory=dict)
    gain: Callable[[float], float] = lambda beat: 1.0

    def note(self, channel: int, beat: float, length: float, pitch: int, velocity: float) -> None:
        """Adds a note, a little uneven in time (about 4 ms) and strength, as people play."""
        loud = velocity * self.gain(beat) * self.rng.uniform(0.9, 1.1)
        start = max(0.0, beat + self.rng.gauss(0, 0.007))
        self.notes.append((channel, start, length, pitch, max(1, min(127, round(loud)))))

    def hit(self, beat: float, drum: int, velocity: float) -> None:
        """Adds a drum stroke."""
        self.note(DRUMS, beat, 0.2, drum, velocity)

    def chord(self, channel: int, beat: float, length: float, pitches: tuple[int, ...], velocity: float) -> None:
        """Adds several notes at once."""
        for pitch in pitches:
            self.note(channel, beat, length, pitch, velocity)


def melody(score: Score, channel: int, bar: float, beats: int, chord: tuple[int, ...], root: int) -> None:
    """A tune of chord tones in quarters and eighths, with rests."""
    at = 0.0
    while at < beats:
        length = score.rng.choice([0.5, 1.0, 1.0, 1.5])
        if score.rng.random() < 0.8:
            score.note(channel, bar + at, length * 0.9, root + score.rng.choice(chord), 80)
        at += length


def rock(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 27, 1: 33, 2: 61})
    for eighth in range(8):
        score.hit(bar + eighth / 2, HAT, 80 if eighth % 2 == 0 else 55)
        score.note(1, bar + eighth / 2, 0.45, root - 24 + chord[0], 90)
    for beat, drum in [(0, KICK), (2, KICK), (2.5, KICK), (1, SNARE), (3, SNARE)]:
        score.hit(bar + beat, drum, 105)
    for beat in (0, 1.5, 3):
        score.chord(0, bar + beat, 0.9, tuple(root + p for p in chord), 75)
    melody(score, 2, bar, 4, chord, root + 12)


def house(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 89, 1: 38, 2: 81})
    for beat in range(4):
        score.hit(bar + beat, KICK, 115)
        score.hit(bar + beat + 0.5, OPEN_HAT, 85)
        score.note(1, bar + beat + 0.5, 0.4, root - 24 + chord[0], 95)
    for beat in (1, 3):
        score.hit(bar + beat, CLAP, 95)
    score.chord(0, bar, 3.9, tuple(root + p for p in chord), 70)
    melody(score, 2, bar, 4, chord, root + 12)


def ballad(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 0, 1: 32, 2: 73})
    for eighth, degree in enumerate((0, 1, 2, 1, 0, 1, 2, 1)):
        score.note(0, bar + eighth / 2, 0.6, root + chord[degree], 78 if eighth % 4 == 0 else 60)
    score.note(1, bar, 1.9, root - 24 + chord[0], 85)
    score.note(1, bar + 2, 1.9, root - 24 + chord[2], 75)
    score.hit(bar, KICK, 75)
    score.hit(bar + 2, RIM, 70)
    melody(score, 2, bar, 4, chord, root + 12)


def funk(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 4, 1: 36, 2: 65})
    for sixteenth in range(16):
        score.hit(bar + sixteenth / 4, HAT, 75 if sixteenth % 4 == 0 else 50)
    for beat in (0, 0.75, 2.5):
        score.hit(bar + beat, KICK, 105)
        score.note(1, bar + beat, 0.3, root - 24 + chord[0], 100)
    for beat in (1, 3):
        score.hit(bar + beat, SNARE, 105)
    score.note(1, bar + 3.5, 0.3, root - 12 + chord[0], 90)
    for beat in (0.5, 1.75, 2, 3.25):
        score.chord(0, bar + beat, 0.25, tuple(root + p for p in chord), 70)


def latin(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 0, 1: 32, 2: 56})
    for beat in range(4):
        score.hit(bar + beat, COWBELL, 90 if beat % 2 == 0 else 70)
        score.hit(bar + beat + 0.5, SHAKER, 60)
    for beat in (1, 3, 3.5):
        score.hit(bar + beat, CONGA, 95)
    for beat, degree in ((0, 0), (1.5, 2), (2, 0), (3, 2)):
        score.note(1, bar + beat, 0.8, root - 24 + chord[degree], 95)
    for beat in (0, 1, 1.5, 2.5, 3.5):
        score.chord(0, bar + beat, 0.4, tuple(root + p for p in chord), 75)
    melody(score, 2, bar, 4, chord, root + 12)


def march(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 61, 1: 58, 2: 72})
    for beat in (0, 2):
        score.hit(bar + beat, KICK, 100)
        score.note(1, bar + beat, 0.8, root - 24 + chord[0 if beat == 0 else 2], 100)
    for beat in (1, 3):
        score.hit(bar + beat, SNARE, 85)
        score.chord(0, bar + beat, 0.5, tuple(root + p for p in chord), 75)
    melody(score, 2, bar, 4, chord, root + 12)


def piano(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 0})
    score.note(0, bar, 1.8, root - 24 + chord[0], 85)
    score.note(0, bar + 2, 1.8, root - 24 + chord[2], 75)
    for beat in range(4):
        score.chord(0, bar + beat, 0.9, tuple(root + p for p in chord), 72 if beat else 82)
    melody(score, 0, bar, 4, chord, root + 12)


def swing(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 0, 1: 32, 2: 66})
    for beat in range(4):
        score.hit(bar + beat, RIDE, 90)
        score.note(1, bar + beat, 0.9, root - 24 + chord[beat % 3], 95)
    for beat in (1, 3):
        score.hit(bar + beat, 44, 85)
        score.hit(bar + beat + 2 / 3, RIDE, 70)
    score.hit(bar, KICK, 70)
    for beat in (1 + 2 / 3, 3):
        score.chord(0, bar + beat, 0.4, tuple(root + p for p in chord), 70)
    at = 0.0
    while at < 4:
        step = score.rng.choice([2 / 3, 1.0]) if at == int(at) else 1 / 3
        if score.rng.random() < 0.8:
            score.note(2, bar + at, step * 0.9, root + 12 + score.rng.choice(chord), 80)
        at = round(at + step, 6)


def waltz(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 48, 1: 43, 2: 40})
    score.note(1, bar, 0.9, root - 24 + chord[0], 100)
    for beat in (1, 2):
        score.chord(0, bar + beat, 0.6, tuple(root + p for p in chord), 70)
    melody(score, 2, bar, 3, chord, root + 12)


def drum_waltz(score: Score, bar: float, chord: tuple[int, ...], root: int) -> None:
    score.programs.update({0: 0, 1: 32, 2: 73})
    score.hit(bar, KICK, 100)
    for beat in (1, 2):
        score.hit(bar + beat, SNARE if beat == 2 else HAT, 75)
        score.chord(0, bar + beat, 0.6, tuple(root + p for p in chord), 70)
    for eighth in range(6):
        score.hit(bar + eighth / 2, RIDE, 65 if eighth % 2 == 0 else 40)
    score.note(1, bar, 1.8, root - 24 + chord[0], 95)
    melody(score, 2, bar, 3, chord, root + 12)


def render(
    name: str,
    kind: str,
    style: Callable[[Score, float, tuple[int, ...], int], None],
    folder: Path,
    soundfont: Path,
    tempo: float,
    beats_per_bar: int = 4,
    seconds: float = 32.0,
    tempo_of_bar: Callable[[int, int], float] | None = None,
    gain: Callable[[float], float] | None = None,
) -> None:
    """Writes one score, its beats and its sound. `tempo_of_bar(bar, bars)` gives the tempo where it changes."""
    score = Score(random.Random(name))
    if gain:
        score.gain = gain
    bars = max(8, round(seconds * tempo / 60 / beats_per_bar))
    progression = PROGRESSIONS[score.rng.randrange(len(PROGRESSIONS))]
    root = 60 + score.rng.randrange(-5, 6)
    for bar in range(bars):
        style(score, float(bar * beats_per_bar), progression[bar % 4], root)

    tempi = [tempo_of_bar(bar, bars) if tempo_of_bar else tempo for bar in range(bars)]
    conductor = mido.MidiTrack()
    previous = 0
    beats, clock = [], 0.0
    for bar, bpm in enumerate(tempi):
        microseconds = mido.bpm2tempo(bpm)
        conductor.append(mido.MetaMessage("set_tempo", tempo=microseconds, time=bar * beats_per_bar * TICKS - previous))
        previous = bar * beats_per_bar * TICKS
        for _ in range(beats_per_bar):
            beats.append(clock)
            clock += microseconds / 1e6

    events = []
    for channel, start, length, pitch, velocity in score.notes:
        events.append((round(start * TICKS), 1, mido.Message("note_on", channel=channel, note=pitch, velocity=velocity)))
        events.append((round((start + length) * TICKS), 0, mido.Message("note_off", channel=channel, note=pitch)))
    events.sort(key=lambda e: (e[0], e[1]))
    track = mido.MidiTrack()
    for channel, program in score.programs.items():
        track.append(mido.Message("program_change", channel=channel, program=program))
    at = 0
    for tick, _, message in events:
        track.append(message.copy(time=tick - at))
        at = tick
    midi = mido.MidiFile(ticks_per_beat=TICKS, tracks=[conductor, track])
    midi.save(folder / f"{name}.mid")
    steady = tempo_of_bar is None
    truth = {
        "kind": kind,
        "tempo": tempo,
        "beatsPerBar": beats_per_bar,
        "steady": steady,
        "beats": beats,
        "downbeats": beats[::beats_per_bar],
    }
    (folder / f"{name}.json").write_text(json.dumps(truth))
    command = ["fluidsynth", "-ni", "-q", "-g", "0.5", "-r", "44100", "-F", str(folder / f"{name}.wav")]
    subprocess.run([*command, str(soundfont), str(folder / f"{name}.mid")], check=True, capture_output=True)


def write_all(folder: Path, soundfont: Path) -> None:
    """Renders every score into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    straight = {"rock": rock, "house": house, "ballad": ballad, "funk": funk, "latin": latin, "march": march, "piano": piano}
    plan = {
        80: ("rock", "ballad", "funk", "piano"),
        100: ("rock", "funk", "latin", "piano"),
        120: ("rock", "house", "latin", "march"),
        140: ("rock", "house", "march", "ballad"),
        160: ("rock", "house", "march", "latin"),
        180: ("rock", "march", "latin", "piano"),
    }
    for tempo, names in plan.items():
        for name in names:
            render(f"{name}_{tempo}", "straight", straight[name], folder, soundfont, tempo)
    for tempo in (110, 140, 170):
        render(f"swing_{tempo}", "swing", swing, folder, soundfont, tempo)
    for tempo in (88, 120, 150, 172):
        render(f"waltz_{tempo}", "three-four", waltz, folder, soundfont, tempo, 3)
    for tempo in (96, 138):
        render(f"drum_waltz_{tempo}", "three-four", drum_waltz, folder, soundfont, tempo, 3)
    # A sudden change half-way, a slow gain of speed, and a slow loss of it.
    render("change_100_130", "tempo change", rock, folder, soundfont, 115, 4, 48, lambda b, n: 100 if b < n // 2 else 130)
    render("faster_95_125", "tempo change", latin, folder, soundfont, 110, 4, 48, lambda b, n: 95 + 30 * b / (n - 1))
    render("slower_140_110", "tempo change", march, folder, soundfont, 125, 4, 48, lambda b, n: 140 - 30 * b / (n - 1))
    for name, style, tempo in (("rock", rock, 112), ("house", house, 126), ("ballad", ballad, 92)):
        quiet = lambda beat: 0.22 if beat < 32 else 1.0  # noqa: E731
        render(f"quiet_intro_{name}_{tempo}", "quiet intro", style, folder, soundfont, tempo, 4, 48, None, quiet)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--soundfont", type=Path, default=Path("/usr/share/sounds/sf2/FluidR3_GM.sf2"))
    arguments = parser.parse_args()
    write_all(arguments.out, arguments.soundfont)


if __name__ == "__main__":
    main()
