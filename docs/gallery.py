"""The gallery: every kind of picture that the program draws, each made by the command beside it.

`python docs/gallery.py` runs the commands in an empty folder and writes ``gallery.md`` and ``images/gallery``. The page
of a report is taken in where there is a chromium to photograph it.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from PIL import Image, ImageSequence

from slosh_cli.cli import main

PAGE = Path(__file__).with_name("gallery.md")
IMAGES = Path(__file__).parent / "images" / "gallery"
WIDTH = 900
"""Pixels."""
FRAMES = 3
"""Of a replay every so many pictures one stays."""


@dataclass(frozen=True)
class Shot:
    """A picture: the file that the command left, and what it shows."""

    file: str
    shows: str

    @property
    def picture(self) -> Path:
        """The file of the gallery."""
        file = Path(self.file)
        stem = file.parts[1] if "*" in self.file else f"{file.parts[1]}-{file.stem}"
        return IMAGES / (stem + (".gif" if file.suffix == ".gif" else ".png"))


@dataclass(frozen=True)
class Chapter:
    """A command, and pictures that it draws."""

    title: str
    command: str
    shots: tuple[Shot, ...]


SETUP = (
    "slosh init --wagon zacns-like --product petrol --gross 38t --brake k-blocks --speed '100 km/h' -o petrol.yaml",
    "slosh init tank-wagon -o tank-wagon.yaml",
    "slosh init block-brake -o block-brake.yaml",
    "slosh init block-train -o block-train.yaml",
)
INTRODUCTION = """# Gallery

Made by `make pages`. Each command draws the pictures under it, as PNG and as SVG, into the folder after `-o`.
Warnings of a run stand in red under its figures. The files come from four scenarios:

"""
CHAPTERS = (
    Chapter(
        "A stop",
        "slosh run petrol.yaml --set contact.adhesion=wet --twin -o outputs/wet",
        (
            Shot("outputs/wet/contact_forces.png", "The liquid runs forward: it presses the leading wheel and relieves "
                 "the trailing one."),
            Shot("outputs/wet/wheel_speed.png", "Speed and slip of each wheel; a bar marks where a wheel is locked."),
            Shot("outputs/wet/slosh.png", "The surface at both end walls beside the roof, and the force on the tank."),
            Shot("outputs/wet/speed_distance.png", "Speed, deceleration of the car and distance."),
        ),
    ),
    Chapter(
        "A stop with real brakes on a real line",
        "slosh run block-brake.yaml -o outputs/blocks",
        (
            Shot("outputs/blocks/brake.png", "Cast-iron blocks: friction grows as the speed falls, and the torque with "
                 "it."),
            Shot("outputs/blocks/line.png", "Over the distance: speed, wheel loads, falling line, uneven rail."),
        ),
    ),
    Chapter(
        "Runs over each other",
        "slosh compare outputs/wet/solid/run.h5 outputs/wet/run.h5 -o outputs/liquid",
        (Shot("outputs/liquid/compare_wheel_loads.png", "Wheel loads with the liquid and with the equivalent solid."),),
    ),
    Chapter(
        "A study",
        "slosh sweep petrol.yaml --vary tank.fill=0.2:0.8:0.1 --vary contact.adhesion=dry,wet "
        "--show distance,unloading -o outputs/fills",
        (
            Shot("outputs/fills/braking_distance_m.png", "Distance over the fill, on dry and on wet rail; rings mark "
                 "the shortest."),
            Shot("outputs/fills/max_wheel_unloading.png", "Unloading of the worst wheel over the fill, below the usual "
                 "limit."),
        ),
    ),
    Chapter(
        "From which force does a wheel lock?",
        "slosh find petrol.yaml --vary 'braking.blocks.force=5:60 kN' --until first_lock -o outputs/find",
        (Shot("outputs/find/*.png", "How long a wheel is locked, over the force; the dotted line is the force that was "
              "found."),),
    ),
    Chapter(
        "Which force is best?",
        "slosh optimum petrol.yaml --vary 'braking.blocks.force=5:60 kN' --within 'max_wheel_unloading<=0.4' "
        "-o outputs/optimum",
        (Shot("outputs/optimum/*.png", "The distance over the force; hollow stops are outside the limit."),),
    ),
    Chapter(
        "What does a stop depend on?",
        "slosh check tank-wagon.yaml --sensitivity --set 'braking.torque=8 kN m' -o outputs/sensitivity",
        (Shot("outputs/sensitivity/sensitivity.png", "Each uncertain value up and down: what it does to distance, "
              "unloading and the first lock."),),
    ),
    Chapter(
        "Slosh modes",
        "slosh tank coefficients tank-wagon.yaml --modes 2 -o outputs/modes",
        (Shot("outputs/modes/mode_3.png", "The second odd mode: potential over the section, surface along the tank."),),
    ),
    Chapter(
        "Slosh modes over the fill",
        "slosh tank chart tank-wagon.yaml -o outputs/chart",
        (Shot("outputs/chart/fill_chart.png", "Frequency, sloshing part of the mass, and height of the force."),),
    ),
    Chapter(
        "The tank alone",
        "slosh tank excite tank-wagon.yaml --deceleration '0.05 g' --ramp '2 s' --duration '30 s' "
        "--set tank.liquid.model=shallow-water -o outputs/excite",
        (Shot("outputs/excite/excite.png", "Force, moment and surface under a prescribed deceleration."),),
    ),
    Chapter(
        "A train",
        "slosh run block-train.yaml -o outputs/train",
        (
            Shot("outputs/train/brake_wave.png", "Forces of all couplings over time: the brake wave, then the liquid."),
            Shot("outputs/train/coupling_forces.png", "Forces of four couplings along the train."),
            Shot("outputs/train/coupling_extremes.png", "Where the largest forces are, and when they come."),
            Shot("outputs/train/train_slosh.png", "The surface at the front wall of every tank."),
            Shot("outputs/train/train_speed.png", "Speeds of four vehicles, and their distances from where their brake "
                 "set in."),
        ),
    ),
    Chapter(
        "A validation",
        "slosh validate kolaei -o outputs/validation",
        (Shot("outputs/validation/kolaei.png", "Forces of a braked tank beside the printed extremes of Table 1."),),
    ),
    Chapter(
        "A replay",
        "slosh animate outputs/wet/run.h5",
        (Shot("outputs/wet/animation.gif", "The stop: liquid, wheels (red where locked) and their loads."),),
    ),
    Chapter(
        "A page to mail",
        "slosh report outputs/wet/run.h5",
        (Shot("outputs/wet/report.html", "The report: one file that replays the stop in a browser."),),
    ),
)  # fmt: skip


def page() -> str:
    """``gallery.md`` with the pictures that there are."""
    texts = [INTRODUCTION, "```sh\n", *(f"{command}\n" for command in SETUP), "```\n"]
    for chapter in CHAPTERS:
        shots = [shot for shot in chapter.shots if shot.picture.exists()]
        texts += [f"\n## {chapter.title}\n\n```sh\n{chapter.command}\n```\n"] if shots else []
        texts += [f"\n{shot.shows}\n\n![{shot.shows}](images/gallery/{shot.picture.name})\n" for shot in shots]
    return "".join(texts)


def draw() -> None:
    """Run every command in the current folder, and take what they drew into the gallery."""
    for command in (*SETUP, *(chapter.command for chapter in CHAPTERS)):
        if main(shlex.split(command)[1:]):
            raise SystemExit(command)
    for shot in (shot for chapter in CHAPTERS for shot in chapter.shots):
        (file,) = Path().glob(shot.file)
        if file.suffix != ".html" or photographed(file):
            shrink(file, shot.picture)


def photographed(file: Path) -> bool:
    """Photograph a page beside itself; False where there is no chromium."""
    browser = shutil.which("chromium")
    if browser is None:
        return False
    shot = [f"--screenshot={file.with_suffix('.png')}", "--window-size=1280,1500", "--virtual-time-budget=4000"]
    words = [browser, "--headless", "--no-sandbox", "--disable-gpu", *shot, file.resolve().as_uri()]
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


def shrink(file: Path, target: Path) -> None:
    """A picture of modest size."""
    with Image.open(file if file.suffix == ".gif" else file.with_suffix(".png")) as found:
        if file.suffix == ".gif":
            frames = [frame.copy() for place, frame in enumerate(ImageSequence.Iterator(found)) if place % FRAMES == 0]
            pause = FRAMES * found.info["duration"]
            frames[0].save(target, save_all=True, append_images=frames[1:], duration=pause, loop=0)
            return
        reduced(found, WIDTH).save(target, optimize=True)


def reduced(found: Image.Image, width: int) -> Image.Image:
    """A picture of a width in pixels, in a palette of its own."""
    size = (width, round(found.height * width / found.width))
    small = found.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    return small.quantize(256, Image.Quantize.MEDIANCUT, kmeans=1)


if __name__ == "__main__":
    shutil.rmtree(IMAGES, ignore_errors=True)
    IMAGES.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        draw()
        os.chdir(IMAGES)
    PAGE.write_text(page(), encoding="utf-8")
