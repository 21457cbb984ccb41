"""Where each of the wagon's 15 coordinates stands in its vectors.

Translations in m, rotations in rad; heave is positive up, pitch positive nose-down, spin positive rolling
forward. Wheel 1 is the leading wheel of the front bogie, wheel 4 the trailing wheel of the rear bogie.
"""

POSITION = 0
CAR_HEAVE = 1
CAR_PITCH = 2
BOGIE_HEAVE = 3  # front; the rear bogie follows two places on
BOGIE_PITCH = 4  # front; the rear bogie follows two places on
WHEEL_HEAVE = 7  # wheels 1 to 4
WHEEL_SPIN = 11  # wheels 1 to 4
BODIES = WHEEL_SPIN
"""Coordinates before the spins; a spin feels nothing but its own contact and brake."""
COORDINATES = 15
WHEELS = 4
