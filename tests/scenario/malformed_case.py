"""Scenarios that must be refused, and the few pieces their cases are made of.

Each case is one file (or the lack of one) with overrides, and the complete list of problems in order. Of
every problem the place, the key path and a telling piece of rule, given value and remedy are stated.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

BASE = """\
format: 1
name: example
description: A wagon to break
wagon:
  car_body: {mass: 21.3 t, pitch_inertia: 4.6e5 kg m^2, centre_height: 2.2 m}
  bogie:
    mass: 1.8 t
    pitch_inertia: 1700 kg m^2
    centre_height: 0.55 m
    wheelbase: 1.8 m
  wheelset:
    mass: 1.4 t
    spin_inertia: 120 kg m^2
    wheel_radius: 0.46 m
  pivot_spacing: 12 m
  traction_height: 0.90 m
  primary_suspension: {stiffness: 2.6e6 N/m, damping: 1.5e4 N s/m}
  secondary_suspension: {stiffness: 6.0e6 N/m, damping: 6.5e4 N s/m}
  running_resistance: {constant: 851 N, linear: 13.5 N s/m, quadratic: 1.244 N s^2/m^2}
tank:
  shape: horizontal-cylinder
  radius: 1.5 m
  length: 15.5 m
  fill: 0.5
  bottom_height: 1.15 m
  liquid: {model: modal, density: 830 kg/m^3}
  coefficients:
    - frequency: 0.69 rad/s
      lambda_1: 137071 kg
      lambda_02: -68461 kg m
      mu: 442163 kg
track:
  rail: {youngs_modulus: 200 GPa, second_moment: 3.06e-5 m^4, mass_per_length: 60 kg/m}
  foundation:
    {stiffness: 1.0e7 N/m^2, shear_stiffness: 666875 N,
     damping: 4.9e3 N s/m^2, shear_damping: 1.0e3 N s}
  domain: {length: 50 m, element_length: 0.5 m}
contact:
  youngs_modulus: 210 GPa
  poisson_ratio: 0.3
  rail_crown_radius: 0.3 m
  kalker_c11: 4.12
  adhesion: dry
braking:
  initial_speed: 80 km/h
  torque: 5 kN m
  onset: 0.5 s
  stop_speed: 0.02 m/s
solver: {tolerance: 1.0e-4, time_limit: 600 s}
output: {interval: 10 ms}
"""
"""A good scenario; the line numbers of the cases below are those of this text."""


@dataclass(frozen=True)
class Expected:
    """One problem: line (or the override it is about), key path, and pieces of rule, given and fix."""

    line: int | None
    key: str
    rule: str
    given: str
    fix: str
    override: str = ""


@dataclass(frozen=True)
class Case:
    """`content` None stands for no file at all, `folder` for a folder in its place."""

    name: str
    content: str | bytes | None
    expected: tuple[Expected, ...]
    overrides: tuple[str, ...] = ()
    folder: bool = False

    def write(self, folder: Path) -> Path:
        """Put the case into `folder` and give the path to load."""
        path = folder / "broken.yaml"
        if self.folder:
            path.mkdir()
        elif isinstance(self.content, bytes):
            path.write_bytes(self.content)
        elif self.content is not None:
            path.write_text(self.content, encoding="utf-8", newline="")
        return path


def edited(*changes: tuple[str, str], text: str = BASE) -> str:
    """BASE with pieces replaced; every piece has to be there exactly once."""
    for old, new in changes:
        if text.count(old) != 1:
            raise ValueError(f"`{old}` is there {text.count(old)} times")
        text = text.replace(old, new)
    return text


def one(name: str, old: str, new: str, *expected: tuple[int | None, str, str, str, str]) -> Case:
    """BASE with one piece replaced."""
    return Case(name, edited((old, new)), tuple(Expected(*entry) for entry in expected))


def override(name: str, *texts: str, expected: tuple[tuple[str, str, str, str, str], ...]) -> Case:
    """BASE with overrides; the problems are given as (override, key, rule, given, fix)."""
    problems = tuple(Expected(None, key, rule, given, fix, place) for place, key, rule, given, fix in expected)
    return Case(name, BASE, problems, texts)


def polygon(name: str, points: str, rule: str, given: str, fix: str) -> Case:
    """BASE with a polygonal tank; the points are on line 22."""
    changed = edited(("horizontal-cylinder", "polygon"), ("radius: 1.5 m", points), ("15.5 m", "10 m"))
    return Case(name, changed, (Expected(22, "tank.points", rule, given, fix),))
