"""The energy ledger: what there is, and the power with which it comes and goes (model section 9)."""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.solver.cells import cells_energy
from slosh_cli.solver.contacts import running_resistance
from slosh_cli.tank.modal import liquid_energy, liquid_loss
from slosh_cli.track.moving import rail_ledger
from slosh_cli.track.vectors import fill
from slosh_cli.wagon.coordinates import BOGIE_PITCH, CAR_PITCH, COORDINATES, WHEEL_HEAVE, WHEEL_SPIN, WHEELS

# places in a point's powers and in the work done so far
BRAKE, CREEP, SUSPENSION, FOUNDATION, RESISTANCE, SLOSH_DAMPING, SLOPE = range(7)
# places in the stored energies
KINETIC, ELASTIC, SLOSH = range(3)


@inner_kernel
def balance(model, cells, point, energies):
    """Energies (J) now into `energies` (3,), powers (W) into `point.power` (7,); `cells` as they are at the point."""
    wagon = model.wagon
    q, v, power = point.q, point.v, point.power
    speed = v[0]
    kinetic = elastic = gravity = loss = tank_speed = 0.0
    for i in range(COORDINATES):
        momentum = force = damping = 0.0
        for j in range(COORDINATES):
            momentum += wagon.mass[i, j] * v[j]
            force += wagon.stiffness[i, j] * q[j]
            damping += wagon.damping[i, j] * v[j]
        kinetic += 0.5 * v[i] * momentum
        elastic += 0.5 * q[i] * force
        loss += v[i] * damping
        gravity -= wagon.weight[i] * q[i]
        tank_speed += wagon.tank_row[i] * v[i]
    tilt = 0.5 * wagon.gravity_stiffness * q[CAR_PITCH] * q[CAR_PITCH]
    rail_kinetic, rail_elastic, foundation = rail_ledger(model.rail, point.rail, point.rail_rate, speed)
    slosh_kinetic, slosh_potential = liquid_energy(
        model.liquid, point.slosh, point.slosh_rate, tank_speed, q[CAR_PITCH], v[CAR_PITCH]
    )
    fill(power, 0.0)
    slopes = point.rail.size // 2
    contact_energy = 0.0
    for i in range(WHEELS):
        spin = v[WHEEL_SPIN + i]
        power[BRAKE] += point.torque[i] * (spin - v[BOGIE_PITCH + 2 * (i // 2)])
        power[CREEP] += point.creep[i] * (speed - wagon.wheel_radius * spin)
        under = model.rail.contact[i]
        power[SLOPE] += point.normal[i] * speed * point.rail[slopes + under]
        approach = max(point.rail[under] - q[WHEEL_HEAVE + i], 0.0)
        contact_energy += 0.4 * model.contact.stiffness * approach**2.5
    resistance, _ = running_resistance(wagon, speed)
    power[SUSPENSION] = loss
    power[FOUNDATION] = foundation
    power[RESISTANCE] = resistance * speed
    power[SLOSH_DAMPING] = liquid_loss(model.liquid, point.slosh_rate)
    cells_kinetic, cells_potential = cells_energy(model, cells, point)
    energies[KINETIC] = kinetic + rail_kinetic + slosh_kinetic + cells_kinetic
    energies[ELASTIC] = elastic - tilt + rail_elastic + contact_energy
    energies[SLOSH] = gravity + tilt + slosh_potential + cells_potential
