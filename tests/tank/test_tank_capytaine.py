"""An independent boundary-element solution of the whole three-dimensional tank, by capytaine (development extra).

The liquid inside is the domain: panels on the wetted wall and ends with their normals into the liquid, the direct
method, the Green function of the free surface. The added mass in surge goes to infinity at the natural frequency.
"""

import math

import numpy as np
import pytest
from rigid_part import added_mass
from tank_examples import cylinder

from slosh_cli.tank.coefficients import computed_modes
from slosh_cli.tank.load import frozen_load

cpt = pytest.importorskip("capytaine")

AROUND, ALONG, UP = 14, 28, 6


def panels(across, along):
    """Quadrilaterals of a grid of points (across, along, 3), by corner number."""
    number = np.arange(across * along).reshape(across, along)
    corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    return np.stack([corner.ravel() for corner in corners], axis=1)


def wetted_surface(radius, length, depth):
    """Vertices and panels, normals into the liquid; z = 0 is the still surface."""
    half_angle, centre = math.acos(1.0 - depth / radius), radius - depth
    angle = np.linspace(-half_angle, half_angle, AROUND + 1)
    y, bottom = radius * np.sin(angle), centre - radius * np.cos(angle)
    x = np.linspace(-length / 2.0, length / 2.0, ALONG + 1)
    wall = np.stack(np.broadcast_arrays(x[None, :], y[:, None], bottom[:, None]), axis=-1)
    share = np.linspace(0.0, 1.0, UP + 1)
    level = bottom[:, None] * (1.0 - share[None, :])
    grids, faces = [wall], [panels(AROUND + 1, ALONG + 1)[:, ::-1]]
    for end, turned in ((-length / 2.0, False), (length / 2.0, True)):
        grids.append(np.stack(np.broadcast_arrays(end, y[:, None], level), axis=-1))
        faces.append(panels(AROUND + 1, UP + 1)[:, :: -1 if turned else 1])
    offsets = np.cumsum([0, *[grid.shape[0] * grid.shape[1] for grid in grids]])
    vertices = np.vstack([grid.reshape(-1, 3) for grid in grids])
    return vertices, np.vstack([face + offset for face, offset in zip(faces, offsets, strict=False)])


@pytest.fixture(scope="module")
def surge():
    """The added mass in surge of a liquid of unit density as a function of frequency, and the panels' volume."""
    vertices, faces = wetted_surface(1.2, 5.75, 1.2)
    mesh = cpt.Mesh(vertices=vertices, faces=faces)
    mesh = mesh.extract_faces(np.flatnonzero(mesh.faces_areas > 1e-9))
    motion = np.zeros((mesh.nb_faces, 3))
    motion[:, 0] = 1.0
    body = cpt.FloatingBody(mesh=mesh, dofs={"Surge": motion}, name="tank")
    solver = cpt.BEMSolver(method="direct")

    def at(omega):
        problem = cpt.RadiationProblem(body=body, radiating_dof="Surge", omega=omega, rho=1.0, g=9.81)
        return float(solver.solve(problem, keep_details=False).added_mass["Surge"])

    volume = -float((mesh.faces_centers[:, 0] * mesh.faces_normals[:, 0] * mesh.faces_areas).sum())
    return at, volume


def test_the_panels_enclose_the_liquid_with_normals_inwards(surge):
    _, volume = surge
    assert volume == pytest.approx(frozen_load(cylinder()).mass / 998.2, rel=0.01)


def test_first_frequency(surge):
    from scipy.optimize import brentq

    at, _ = surge
    omega = computed_modes(cylinder(), 1)[0].frequency
    found = brentq(lambda one: 1.0 / at(one), 0.97 * omega, 1.03 * omega, xtol=1e-5)
    print(f"\nfirst frequency {omega:.5f} rad/s, by boundary elements {found:.5f}: {found / omega - 1.0:+.3%}")  # noqa: T201
    assert found == pytest.approx(omega, rel=0.003)


def test_added_mass_without_and_with_waves(surge):
    at, volume = surge
    tank = cylinder()
    mass = frozen_load(tank).mass
    rigid = added_mass(tank) / mass
    assert at(float("inf")) / volume == pytest.approx(rigid, rel=0.02)
    modes = computed_modes(tank, 5)
    waves = sum(mode.slosh_mass / mass / (1.0 - 1.0 / mode.frequency**2) for mode in modes)
    assert at(1.0) / volume == pytest.approx(rigid + waves, rel=0.02)
