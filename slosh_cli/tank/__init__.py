"""The tank: cross-section geometry, the load at rest and the slosh coefficients."""
