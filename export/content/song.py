"""Composes, renders and masters the demo song: public/demo/song.mp3 (120 BPM, 4/4, first downbeat at 0 s).

    python export/content/song.py [--keep FOLDER]

Needs fluidsynth with the FluidR3 GM sound font (MIT) and ffmpeg on the PATH. The composition is our own.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import tempfile
from pathlib import Path

import mido

OUT = Path(__file__).resolve().parents[2] / "public/demo/song.mp3"
FONT = "/usr/share/sounds/sf2/FluidR3_GM.sf2"
TEMPO = 120
BARS = 30
TICKS = 480
STEP = TICKS // 4  # a sixteenth
SWING = 14  # ticks by which every second sixteenth is late

#: section = first bar; the form of the song
INTRO, GROOVE, DROP, BREAK, FINALE, ENDING = 0, 4, 8, 16, 20, 28

#: instrument: channel, GM program, pan, volume
PARTS = {
    "bass": (0, 38, 64, 112),
    "keys": (1, 4, 52, 92),
    "guitar": (2, 28, 88, 84),
    "strings": (3, 50, 64, 66),
    "lead": (4, 80, 66, 84),
    "double": (5, 11, 58, 92),
    "brass": (6, 62, 74, 82),
    "pad": (7, 89, 64, 84),
    "riser": (8, 119, 64, 100),
}
DRUMS = 9
KICK, SNARE, CLAP, HAT, OPEN, CRASH, TAMB, RIDE = 36, 38, 39, 42, 46, 49, 54, 51
TOMS, CONGAS, SNAP = (50, 47, 43, 41), (62, 63, 64), 37

# F major 7 - E 7 - A minor 9 - G minor 7 / C 9, then a rising line for the breakdown
CHORDS = [
    [(0, 16, 41, (57, 60, 64, 67))],
    [(0, 16, 40, (56, 59, 62, 67))],
    [(0, 16, 45, (55, 59, 60, 64))],
    [(0, 8, 43, (58, 62, 65, 69)), (8, 8, 36, (58, 62, 64, 67))],
]
RISE = [
    [(0, 16, 38, (57, 60, 64, 65))],
    [(0, 16, 40, (55, 59, 62, 64))],
    [(0, 16, 41, (57, 60, 64, 67))],
    [(0, 16, 43, (57, 59, 64, 65))],
]

#: the hook: per bar (sixteenth, length, note)
HOOK = [
    [(0, 2, 69), (3, 2, 72), (6, 3, 76), (10, 2, 74), (12, 2, 72), (14, 2, 69)],
    [(0, 3, 68), (3, 2, 71), (6, 4, 74), (11, 1, 72), (12, 4, 71)],
    [(0, 2, 72), (3, 2, 76), (6, 4, 81), (10, 2, 79), (12, 2, 76), (14, 2, 74)],
    [(0, 3, 74), (4, 2, 70), (6, 2, 74), (8, 3, 76), (11, 1, 74), (12, 3, 72), (15, 1, 67)],
]
ANSWER = [
    [(0, 1, 76), (2, 1, 76), (3, 3, 72), (8, 1, 76), (10, 1, 77), (11, 4, 79)],
    [(0, 1, 80), (2, 1, 79), (3, 3, 76), (8, 2, 74), (11, 4, 71)],
    [(0, 1, 72), (2, 1, 74), (3, 3, 76), (6, 2, 79), (9, 2, 81), (12, 4, 84)],
    [(0, 2, 82), (3, 2, 81), (6, 2, 77), (8, 3, 79), (12, 1, 76), (14, 2, 72)],
]
SONG_BREAK = [
    [(0, 6, 77), (6, 4, 76), (12, 4, 72)],
    [(0, 6, 74), (6, 4, 71), (12, 4, 67)],
    [(0, 6, 76), (6, 4, 77), (12, 4, 79)],
    [(0, 4, 81), (4, 4, 79), (8, 4, 77), (12, 4, 74)],
]


class Score:
    """Notes per part, in sixteenths from the start."""

    def __init__(self) -> None:
        self.events: dict[str, list[tuple[int, mido.Message]]] = {}
        self.chance = random.Random(7)

    def note(self, part: str, bar: int, step: float, length: float, pitch: int, velocity: float) -> None:
        """Adds a note; `velocity` is varied a little and odd sixteenths swing, always the same way."""
        channel = DRUMS if part == "drums" else PARTS[part][0]
        at = int(round((bar * 16 + step) * STEP)) + (SWING if step % 2 == 1 else 0)
        loud = int(max(1, min(127, velocity + self.chance.uniform(-5, 5))))
        list_ = self.events.setdefault(part, [])
        list_.append((at, mido.Message("note_on", channel=channel, note=pitch, velocity=loud)))
        list_.append((at + max(20, int(length * STEP) - 12), mido.Message("note_off", channel=channel, note=pitch)))

    def write(self, parts: list[str], path: Path) -> None:
        """Writes a MIDI file with these parts."""
        file = mido.MidiFile(ticks_per_beat=TICKS)
        head = mido.MidiTrack([mido.MetaMessage("set_tempo", tempo=mido.bpm2tempo(TEMPO))])
        file.tracks.append(head)
        for part in parts:
            track = mido.MidiTrack()
            if part == "drums":
                track.append(mido.Message("program_change", channel=DRUMS, program=24))
                track.append(mido.Message("control_change", channel=DRUMS, control=91, value=18))
            else:
                channel, program, pan, volume = PARTS[part]
                track.append(mido.Message("program_change", channel=channel, program=program))
                for control, value in ((7, volume), (10, pan), (91, 20 if part == "bass" else 46), (93, 12)):
                    track.append(mido.Message("control_change", channel=channel, control=control, value=value))
            now = 0
            # note-offs first at equal times, so that repeated notes sound
            for at, message in sorted(self.events.get(part, []), key=lambda e: (e[0], e[1].type == "note_on")):
                track.append(message.copy(time=at - now))
                now = at
            file.tracks.append(track)
        file.save(path)


def chords_of(bar: int) -> list[tuple[int, int, int, tuple[int, ...]]]:
    """(start, length, root, voicing) in a bar."""
    return (RISE if BREAK <= bar < FINALE else CHORDS)[bar % 4]


def chord_at(bar: int, step: float) -> tuple[int, tuple[int, ...]]:
    """Root and voicing that sound at a sixteenth."""
    for start, length, root, voicing in chords_of(bar):
        if start <= step < start + length:
            return root, voicing
    raise ValueError(f"no chord at bar {bar}, step {step}")


def drums(score: Score) -> None:
    """Four on the floor with hats, claps, congas and fills."""
    def hit(bar, step, pitch, velocity):
        score.note("drums", bar, step, 0.9, pitch, velocity)

    for bar in range(ENDING):
        full = GROOVE <= bar < BREAK or FINALE <= bar
        last = bar + 1 in (GROOVE, DROP, FINALE, ENDING)
        if full:
            for step in (0, 4, 8, 12):
                hit(bar, step, KICK, 122 if step == 0 else 116)
            for step in (4, 12):
                hit(bar, step, CLAP, 100)
                hit(bar, step, SNARE, 88)
            for step in range(16):
                hit(bar, step, HAT, (66, 40, 54, 44)[step % 4])
            for step in (2, 6, 10, 14):
                hit(bar, step, OPEN, 74 if bar >= DROP else 56)
        if INTRO <= bar < GROOVE:
            for step in (4, 12):
                hit(bar, step, SNAP if bar < 2 else CLAP, 82)
            for step in range(0, 16, 2):
                hit(bar, step, HAT, 60 if step % 4 == 2 else 46)
            if bar >= 2:
                for step in (0, 8) if bar == 2 else (0, 4, 8):
                    hit(bar, step, KICK, 112)
        if DROP <= bar < BREAK or FINALE <= bar:
            for step, drum in ((0, 0), (3, 1), (6, 0), (7, 2), (10, 1), (13, 2), (14, 0)):
                hit(bar, step, CONGAS[drum], 60)
            for step in (2, 6, 10, 14):
                hit(bar, step, TAMB, 58)
        if BREAK <= bar < FINALE:
            for step in (0, 4, 8, 12):
                hit(bar, step, TAMB, 44)
                if bar >= BREAK + 2:
                    hit(bar, step, KICK, 84 + 8 * (bar - BREAK))
            if bar == BREAK + 2:
                for step in range(0, 16, 2):
                    hit(bar, step, SNARE, 44 + 2 * step)
            if bar == BREAK + 3:
                for step in range(16):
                    hit(bar, step, SNARE, 58 + 4 * step)
        if last and bar >= GROOVE:
            for i, step in enumerate((12, 13, 14, 15)):
                hit(bar, step, TOMS[i], 96 + 4 * i)
        if bar in (GROOVE, DROP, DROP + 4, FINALE, FINALE + 4):
            hit(bar, 0, CRASH, 104)
    for step in (0, 3, 6):
        hit(ENDING, step, KICK, 118)
        hit(ENDING, step, CLAP, 100)
    for i, step in enumerate((8, 9, 10, 11, 12, 13)):
        hit(ENDING, step, TOMS[min(3, i // 2)], 90 + 4 * i)
    hit(ENDING + 1, 0, KICK, 124)
    hit(ENDING + 1, 0, CRASH, 118)


def bass(score: Score) -> None:
    """Octave bass that leaves room for the kick."""
    for bar in range(2, ENDING):
        if bar < GROOVE or BREAK <= bar < FINALE:
            for start, length, root, _ in chords_of(bar):
                if bar != 2:
                    score.note("bass", bar, start, length, root, 88)
            continue
        line = ((0, 2, 0), (3, 1, 0), (4.0, 1, 12), (6, 2, 12), (8, 2, 0), (10, 1, 7), (11, 1, 12), (13, 1, 0), (14, 2, 12))
        for step, length, interval in line:
            root, _ = chord_at(bar, step)
            score.note("bass", bar, step, length * 0.9, root + interval, 112 if step in (0, 8) else 98)
    for step in (0, 3, 6):
        score.note("bass", ENDING, step, 1.6, 41 if step < 6 else 43, 116)
    score.note("bass", ENDING + 1, 0, 12, 33, 118)


def harmony(score: Score) -> None:
    """Electric piano, guitar, strings, brass and pad."""
    for bar in range(ENDING):
        for start, length, root, voicing in chords_of(bar):
            if bar < GROOVE or BREAK <= bar < FINALE:
                for pitch in voicing:
                    score.note("keys", bar, start, length, pitch, 74)
                    score.note("pad", bar, start, length, pitch, 70 + 6 * (bar % 4))
            if DROP <= bar < BREAK or FINALE <= bar:
                for pitch in voicing[1:]:
                    score.note("strings", bar, start, length, pitch + 12, 74)
        if GROOVE <= bar < BREAK or FINALE <= bar:
            for step, length, velocity in ((0, 2.5, 88), (3, 1, 74), (6, 2, 84), (10, 1, 70), (11, 2.5, 82)):
                for pitch in chord_at(bar, step)[1]:
                    score.note("keys", bar, step, length, pitch, velocity)
            for step in (2, 3, 6, 7, 10, 11, 14, 15):
                for pitch in chord_at(bar, step)[1][1:]:
                    score.note("guitar", bar, step, 0.8, pitch + 12, 84 if step % 4 == 2 else 62)
        if bar == 1 or bar == 3:
            for step in (10, 11, 14):
                for pitch in chord_at(bar, step)[1][1:]:
                    score.note("guitar", bar, step, 0.8, pitch + 12, 76)
        if FINALE <= bar or DROP + 4 <= bar < BREAK:
            for step, length in ((3, 1), (6, 2)) if bar % 2 == 0 else ((3, 1), (6, 1), (11, 1), (14, 2)):
                for pitch in chord_at(bar, step)[1]:
                    score.note("brass", bar, step, length, pitch + 12, 88)
    for step, voicing in ((0, (57, 60, 64, 67)), (3, (57, 60, 64, 67)), (6, (59, 62, 65, 67))):
        for part in ("keys", "brass"):
            for pitch in voicing:
                score.note(part, ENDING, step, 1.8, pitch + (12 if part == "brass" else 0), 102)
    for pitch in (57, 60, 64, 67, 71):
        for part, length in (("keys", 14), ("strings", 14), ("pad", 14)):
            score.note(part, ENDING + 1, 0, length, pitch, 96)
        score.note("brass", ENDING + 1, 0, 4, pitch + 12, 100)
    score.note("riser", FINALE - 1, 0, 15.5, 60, 112)
    score.note("riser", DROP - 1, 0, 15.5, 60, 96)


def melody(score: Score) -> None:
    """The hook, its answer, and a slower song for the breakdown."""
    for bar in range(ENDING):
        if bar < DROP and bar >= GROOVE + 2:
            line, parts = HOOK[bar % 4], ("double",)
        elif DROP <= bar < DROP + 4 or FINALE + 4 <= bar:
            line, parts = HOOK[bar % 4], ("lead", "double")
        elif DROP + 4 <= bar < BREAK or FINALE <= bar:
            line, parts = (ANSWER if bar < BREAK or bar >= FINALE + 4 else HOOK)[bar % 4], ("lead", "double")
        elif BREAK <= bar < FINALE:
            line, parts = SONG_BREAK[bar % 4], ("double",)
        elif bar == 2 or bar == 3:
            line, parts = [n for n in HOOK[bar % 4] if n[0] >= 6], ("double",)
        else:
            continue
        for step, length, pitch in line:
            for part in parts:
                score.note(part, bar, step, length, pitch, 100 if step % 4 == 0 else 90)
    for part in ("lead", "double"):
        score.note(part, ENDING, 0, 2, 76, 104)
        score.note(part, ENDING, 3, 2, 77, 104)
        score.note(part, ENDING, 6, 2, 79, 108)
        score.note(part, ENDING + 1, 0, 10, 81, 112)


def run(*command: str) -> str:
    """Runs a program; returns what it printed on stderr."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{done.stderr[-2000:]}")
    return done.stderr


def measure_loudness(path: Path) -> dict[str, str]:
    """ffmpeg's EBU R128 measurement of a file."""
    text = run("ffmpeg", "-hide_banner", "-i", str(path), "-af", "loudnorm=print_format=json", "-f", "null", "-")
    return json.loads(text[text.rindex("{") : text.rindex("}") + 1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keep", type=Path, help="folder that keeps the MIDI and wav files")
    parser.add_argument("--font", default=FONT)
    options = parser.parse_args()
    score = Score()
    for write in (drums, bass, harmony, melody):
        write(score)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for stem, parts in (("drums", ["drums"]), ("band", list(PARTS))):
            score.write(parts, folder / f"{stem}.mid")
            run("fluidsynth", "-ni", "-g", "0.5", "-r", "44100", "-R", "1", "-C", "1", "-F", str(folder / f"{stem}.wav"),
                options.font, str(folder / f"{stem}.mid"))  # fmt: skip
        seconds = BARS * 4 * 60 / TEMPO
        # the kick ducks the band (side-chain), then glue, tone and a limiter
        graph = (
            f"[0:a]apad,atrim=0:{seconds},asplit[d][key];[1:a]apad,atrim=0:{seconds},highpass=f=32[b];"
            "[b][key]sidechaincompress=threshold=0.06:ratio=5:attack=4:release=170:makeup=1.1[pumped];"
            "[d]acompressor=threshold=0.25:ratio=3:attack=8:release=120:makeup=1.5[dd];"
            "[dd][pumped]amix=inputs=2:normalize=0:weights=1 1.25,"
            "equalizer=f=90:t=q:w=1:g=1.5,equalizer=f=320:t=q:w=1.2:g=-2,treble=g=3:f=8000,"
            "acompressor=threshold=0.3:ratio=2:attack=20:release=200:makeup=1.4,"
            f"afade=t=out:st={seconds - 1.6}:d=1.6"
        )
        mix = folder / "mix.wav"
        run("ffmpeg", "-y", "-i", str(folder / "drums.wav"), "-i", str(folder / "band.wav"), "-filter_complex", graph,
            "-ar", "44100", "-c:a", "pcm_f32le", str(mix))  # fmt: skip
        level = float(measure_loudness(mix)["input_i"])
        master = folder / "master.wav"
        # a plain gain into a true limiter keeps the groove; loudnorm's dynamic mode would breathe with it
        run("ffmpeg", "-y", "-i", str(mix), "-af", f"volume={-13.7 - level}dB,alimiter=limit=0.84:attack=4:release=60:level=false",
            "-ar", "44100", "-c:a", "pcm_s16le", str(master))  # fmt: skip
        OUT.parent.mkdir(parents=True, exist_ok=True)
        run("ffmpeg", "-y", "-i", str(master), "-map_metadata", "-1", "-metadata", "title=Warm Circuit", "-metadata", "artist=Posebeat",
            "-c:a", "libmp3lame", "-b:a", "160k", "-joint_stereo", "1", str(OUT))  # fmt: skip
        final = measure_loudness(OUT)
    print(f"{OUT.name}: {OUT.stat().st_size} bytes, {final['input_i']} LUFS, true peak {final['input_tp']} dB, range {final['input_lra']} LU")


if __name__ == "__main__":
    main()
