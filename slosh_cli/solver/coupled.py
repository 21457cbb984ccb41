"""The couplings' forces at a stage: a train's vehicles held together in Newton (theory section 16)."""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.method import BASE, END, GAMMA, MIDDLE, START


@inner_kernel
def _coupled_place(vehicle, q):
    """Displacement (m) along the track of a vehicle's coupling points at coordinates `q`; or the same of rates."""
    row, total = vehicle.wagon.coupling_row, 0.0
    for i in range(vehicle.wagon.first_spin):
        total += row[i] * q[i]
    return total


@inner_kernel
def guess_couplings(train, stage, part):
    """Start the iteration of a stage from coupling forces on the line from the start to the middle."""
    force = train.couplings.force
    for j in range(force.shape[1]):
        force[stage, j] = force[START, j] + part * (force[MIDDLE, j] - force[START, j])
    put_coupling_forces(train, stage)


@inner_kernel
def put_coupling_forces(train, stage):
    """Let the couplings' forces of a stage act on the vehicles."""
    vehicles, force, half = train.vehicles, train.couplings.force, train.couplings.half
    count = force.shape[1]
    for k in range(count + 1 if count > 0 else 0):
        ahead, behind = force[stage, k - 1] if k > 0 else 0.0, force[stage, k] if k < count else 0.0
        vehicles[k].coupling_force = half * (behind - ahead)


@inner_kernel
def close_couplings(train, stage, step, allowed):
    """Hold the couplings' forces against their law where Newton has put the vehicles: True where all is within the
    `allowed` force (N).

    If not, the forces take Newton's update. A vehicle then answers to a newton at its coupling points by its bodies'
    own compliance, and each coupling sees its neighbours: the system is tridiagonal.
    """
    law, vehicles, largest = train.couplings, train.vehicles, 0.0
    apart = 2.0 * step * (1.0 if stage < END else 1.0 / GAMMA - 1.0)
    count, ahead, rate_ahead = law.gap.size, 0.0, 0.0
    for k in range(count + 1 if count > 0 else 0):
        base, acceleration = vehicles[k].points[BASE], _coupled_place(vehicles[k], vehicles[k].points[stage].a)
        place = _coupled_place(vehicles[k], base.q) + step * step * acceleration
        rate = _coupled_place(vehicles[k], base.v) + step * acceleration
        if k > 0:
            compression = place - ahead - law.origin[k - 1]
            force, by_place, by_rate = law.follow(k - 1, stage, apart, compression, rate - rate_ahead)
            law.gap[k - 1] = force - law.force[stage, k - 1]
            law.stiffness[k - 1] = law.half * step * (step * by_place + by_rate)
            largest = max(largest, abs(law.gap[k - 1]))
        ahead, rate_ahead = place, rate
    if largest <= allowed:
        return True
    _solve_couplings(train)
    for j in range(count):
        law.force[stage, j] += law.gap[j]
    put_coupling_forces(train, stage)
    return False


@inner_kernel
def _compliance(vehicle):
    """Acceleration (m/s^2) of the coupling points per newton there, the contacts' answer left out."""
    return _coupled_place(vehicle, vehicle.scratch.response[vehicle.scratch.response.shape[0] - 1])


@inner_kernel
def _solve_couplings(train):
    """From gaps to changes of the couplings' forces, N, in place: elimination from the front, then back."""
    law, vehicles = train.couplings, train.vehicles
    gap, stiffness, ratio = law.gap, law.stiffness, law.ratio
    front, before = _compliance(vehicles[0]), 0.0
    for j in range(gap.size):
        rear = _compliance(vehicles[j + 1])
        lower = -stiffness[j] * front if j > 0 else 0.0
        pivot = 1.0 + stiffness[j] * (front + rear) - lower * before
        gap[j] = (gap[j] - lower * (gap[j - 1] if j > 0 else 0.0)) / pivot
        ratio[j] = before = -stiffness[j] * rear / pivot
        front = rear
    for j in range(gap.size - 2, -1, -1):
        gap[j] -= ratio[j] * gap[j + 1]
