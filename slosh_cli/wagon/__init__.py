"""The wagon: 15 coordinates, one Lagrangian, constant matrices."""
