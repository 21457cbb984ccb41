"""Energy of wagon and rail, and the powers that change it: their sum must stay what it was at the start."""

import numpy as np

from .plain_motion import PHI_DOFS, REACTION_DOFS, Brake, Motion, Stage, System
from .plain_rail import Rail, times
from .plain_wagon import S

POWERS = ("brake", "creep", "suspension", "resistance", "foundation", "slope")


def energy(system: System, motion: Motion, N: np.ndarray) -> float:
    """Kinetic, elastic, slosh and gravity energy of wagon, contacts, rail and foundation (J)."""
    wagon, rail, q, u = system.wagon, system.rail, motion.q, motion.u
    approach = np.cbrt(N / system.contact.hertz) ** 2
    rolling = 0.5 * u @ wagon.mass @ u + 0.5 * q @ wagon.stiffness @ q - wagon.weight @ q
    return float(rolling + 0.4 * N @ approach + _rail_energy(rail, motion, u[S]))


def _rail_energy(rail: Rail, motion: Motion, V: float) -> float:
    """Energy of rail and foundation; the rail's material moves vertically at y_t - V y_r."""
    y, v = motion.y, motion.v
    elastic = rail.bending * rail.I22 + rail.stiffness * rail.I00 + rail.shear * rail.I11
    material = v @ times(rail.I00, v) - 2.0 * V * v @ times(rail.I01, y) + V**2 * y @ times(rail.I11, y)
    return 0.5 * rail.mass * material + 0.5 * y @ times(elastic, y)


def powers(system: System, brake: Brake, stage: Stage) -> np.ndarray:
    """Powers (6,) taken by brake, creep, suspensions, resistance, foundation, and given by slope work."""
    motion, rail = stage.motion, system.rail
    u, y, v, V = motion.u, motion.y, motion.v, motion.u[S]
    torque = system.transmitted_torque(brake, stage.f)
    material = v @ times(rail.I00, v) - 2.0 * V * v @ times(rail.I01, y) + V**2 * y @ times(rail.I11, y)
    bent = v @ times(rail.I11, v) - 2.0 * V * v @ times(rail.I12, y) + V**2 * y @ times(rail.I22, y)
    return np.array(
        [
            torque @ (u[PHI_DOFS] - u[REACTION_DOFS]),
            stage.f @ system.slip(u),
            u @ system.wagon.damping @ u,
            system.resisting_force(V)[0] * V,
            rail.damping * material + rail.shear_damping * bent,
            stage.N @ y[rail.wheel_dofs + 1] * V,
        ]
    )


def taken(work: np.ndarray) -> float:
    """Energy that has left the system, from the time integrals of the powers."""
    return float(work[:5].sum() - work[5])
