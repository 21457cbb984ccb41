"""Random plausible wagons and trains, and what every run of them is held to: `make campaign N=1000 TRAINS=50`.

`wagons` and `trains` draw from a seed, `judge` judges, `__main__` runs them side by side and counts.
"""
