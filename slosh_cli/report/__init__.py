"""Figures of runs, studies, tanks and validation cases; what is named here is known without matplotlib."""

from typing import Final

FORMATS: Final = ("png", "svg")
"""Kinds of files that every figure is written as."""
FIGURE_NAMES: Final = ("contact_forces", "speed_distance", "wheel_speed", "slosh", "brake", "line")
"""Every figure of a run, by the name of its files."""
TRAIN_FIGURES: Final = ("coupling_forces", "coupling_extremes", "brake_wave", "train_speed", "train_slosh")
"""Every figure of a train's run."""
