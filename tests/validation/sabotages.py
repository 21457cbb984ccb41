"""Deliberate errors in the program, as edits of its source text, and the case that has to turn red.

Most are made in memory: a function, or a method on its class, is made anew from its edited source and put in the
place of the true one. An edited kernel is plain Python then, which other kernels refuse to call: none of them can be
compiled with it and kept. Errors in kernels that the time loop is made of need a copy of the whole package, compiled
on its own.
"""

from __future__ import annotations

import inspect
import textwrap
from dataclasses import dataclass
from importlib import import_module
from typing import Any


@dataclass(frozen=True)
class Edit:
    """In `function` of `module` (dotted, within slosh_cli), `old` becomes `new`."""

    module: str
    function: str
    old: str
    new: str


@dataclass(frozen=True)
class Sabotage:
    """An error, the case that it must turn red, and a part of the quantity of a row that must be among the red ones."""

    case: str
    edits: tuple[Edit, ...]
    red: str = ""
    copy: bool = False


def edit(case: str, module: str, function: str, old: str, new: str, red: str = "", copy: bool = False) -> Sabotage:
    return Sabotage(case, (Edit(module, function, old, new),), red, copy)


STEADY = ("track.mem", "steady_rows")
MOVING = ("track.moving", "_matrices")
MODE = ("tank.longitudinal", "longitudinal_mode")

SABOTAGES: dict[str, Sabotage] = {
    "interfoam_pressure": edit(
        "interfoam",
        "tank.section_table",
        "section_table",
        "pressure = depth * area - first",
        "pressure = 0.8 * (depth * area - first)",
        "force",
    ),
    "cfd_pressure": edit(
        "cfd",
        "tank.section_table",
        "section_table",
        "pressure = depth * area - first",
        "pressure = 0.8 * (depth * area - first)",
        "force over m a, cylinder",
    ),
    "measured_lambda_1": edit("measured", *MODE, "along * 2.0 * kappa", "along * kappa", "centre of mass, swayed"),
    "measured_pressure": edit(
        "measured",
        "tank.section_table",
        "section_table",
        "pressure = depth * area - first",
        "pressure = 0.8 * (depth * area - first)",
        "the bore is early",
    ),
    "moving_load_tension": edit(
        "moving-load", *STEADY, "rail.mass * speed**2", "2 * rail.mass * speed**2", "deflection"
    ),
    "moving_load_bending": edit(
        "moving-load", *STEADY, "rail.bending_stiffness *", "1.001 * rail.bending_stiffness *", "deflection"
    ),
    "moving_load_kernel": edit(
        "moving-load",
        *MOVING,
        "- inertia * speed * speed",
        "+ inertia * speed * speed",
        "kernel",
        copy=True,
    ),
    "moving_load_damped_drift": edit(
        "moving-load-damped", *STEADY, "- rail.damping * speed", "+ rail.damping * speed", "largest error"
    ),
    "moving_load_damped_twist": edit(
        "moving-load-damped", *STEADY, "- rail.shear_damping * speed", "- 0.0 * speed", "largest error"
    ),
    "critical_speed_formula": edit(
        "critical-speed", "track.mem", "critical_speed", "2 * np.sqrt", "np.sqrt", "critical speed, "
    ),
    "critical_speed_refusal": edit(
        "critical-speed", "solver.setup", "_check_speed", ">= limit", ">= 1e3 * limit", "1.02 of a critical speed"
    ),
    "mem_vs_fem_convection": edit(
        "mem-vs-fem", *MOVING, "-2.0 * inertia * speed", "2.0 * inertia * speed", "rail under wheel", copy=True
    ),
    "mem_vs_fem_acceleration": edit(
        "mem-vs-fem", *MOVING, "- inertia * acceleration", "+ inertia * acceleration", "rail under wheel", copy=True
    ),
    "rectangular_tank_lambda_02": edit(
        "rectangular-tank", *MODE, "height_moment - along * slope", "height_moment + along * slope", "lambda_02"
    ),
    "rectangular_tank_gravity": edit("rectangular-tank", *MODE, "STANDARD_GRAVITY * kappa", "9.80 * kappa", "omega"),
    "v_trough_lambda_02": edit(
        "v-trough", *MODE, "elements.area_of_slope @", "(elements.area_of_slope - elements.surface_of) @", "lambda_02"
    ),
    "v_trough_wavenumber": edit(
        "v-trough",
        "tank.eigenproblem",
        "HalfSectionElements.modes",
        "wavenumber**2 *",
        "0.5 * wavenumber**2 *",
        "omega",
    ),
    "circular_cylinder_chords": edit(
        "circular-cylinder",
        "tank.mesh",
        "SectionMesh.for_finite_elements",
        "replace(curved, doflocs=places)",
        "curved",
    ),
    "circular_cylinder_width": edit("circular-cylinder", *MODE, "along * 2.0 * kappa", "along * kappa", "lambda_1"),
    "kolaei_lambda_1": edit("kolaei", *MODE, "along * 2.0 * kappa", "along * kappa", "consistent with a 2.0 s ramp"),
    "kolaei_force_sign": edit(
        "kolaei", "tank.modal", "ModalLiquid.force", "force -= ", "force += ", "as the step begins"
    ),
    "hertz_poisson": edit("hertz", "track.hertz", "hertz_contact", "(1 - poisson_ratio**2)", "1.0", "approach"),
    "hertz_exponent": edit("hertz", "track.contact", "ContactModel.normal_force", "closed * root", "closed", "kernel"),
    "hertz_axes": edit(
        "hertz",
        "track.hertz",
        "HertzContact.semi_axes",
        "product * self.axis_ratio",
        "product / self.axis_ratio",
        "m at",
    ),
    "polach_square": edit(
        "polach",
        "track.contact",
        "ContactModel.creep_force",
        "adhesion / (1.0 + adhesion * adhesion)",
        "adhesion / (1.0 + adhesion * eps)",
        "wet",
    ),
    "polach_wet_parameters": edit(
        "polach", "track.contact", "contact_model", "slip_reduction=adhesion.kS", "slip_reduction=0.4", "wet"
    ),
    "polach_quarter": edit("polach", "track.contact", "contact_model", "0.25 * math.pi", "math.pi", "initial slope"),
    "point_mass_half_wagon": edit(
        "point-mass", "wagon.model", "_mass_matrix", "return 0.5 *", "return 1.0 *", "distance"
    ),
    "point_mass_spin": edit(
        "point-mass",
        "wagon.model",
        "_mass_matrix",
        "(wagon.wheelset.spin_inertia,",
        "(0.5 * wagon.wheelset.spin_inertia,",
        "distance",
    ),
    "point_mass_resistance": edit(
        "point-mass", "solver.setup", "_line", "resistance=HALF *", "resistance=1.0 *", "distance"
    ),
    "gradient_sign": edit(
        "gradient", "solver.setup", "_line", "0.0 - STANDARD_GRAVITY *", "STANDARD_GRAVITY *", "distance on 30 permille"
    ),
    "gradient_profile": edit(
        "gradient", "solver.setup", "_line", "points[:, 0] + behind", "points[:1, 0] + behind", "profile"
    ),
    "gradient_liquid": edit(
        "gradient", "solver.stage", "read_ride", "acceleration - ride.pull[stage]", "acceleration", "surface", copy=True
    ),
    "uneven_rail_lines": edit(
        "uneven-rail",
        "track.spectrum",
        "spectral_lines",
        "number = low + spacing * (np.arange(unevenness.lines, dtype=np.float64) + 0.5)",
        "spacing = (high - low) / max(unevenness.lines - 1, 1); number = np.linspace(low, high, unevenness.lines)",
        "variance",
    ),
    "uneven_rail_sides": edit(
        "uneven-rail", "track.spectrum", "spectral_lines", "np.sqrt(2.0 * scale", "np.sqrt(scale", "variance"
    ),
    "uneven_rail_level": edit(
        "uneven-rail",
        "track.spectrum",
        "_density",
        "form.level *",
        "(1 + 3 * (form.lower == 0)) * form.level *",
        "fra-6",
    ),
    "uneven_rail_height": edit(
        "uneven-rail",
        "track.contact",
        "ContactModel.approach",
        "rail + height - heave",
        "rail - height - heave",
        "in phase",
        copy=True,
    ),
    "wheel_flat_wheel": edit(
        "wheel-flat", "track.surface", "rolling_surface", "flat.wheel - 1", "flat.wheel - 2", "let down"
    ),
    "wheel_flat_length": edit(
        "wheel-flat",
        "track.surface",
        "rolling_surface",
        "flat.length / wheel_radius",
        "2 * flat.length / wheel_radius",
        "let down",
    ),
    "wheel_flat_turn": edit(
        "wheel-flat",
        "track.surface",
        "RollingSurface.flat",
        "angle - 2.0 * math.pi * math.floor",
        "angle - 0.0 * math.pi * math.floor",
        "blows",
        copy=True,
    ),
    "brakes_cast_iron": edit(
        "brakes", "friction", "cast_iron", "5.0 * speed", "4.0 * speed", "blocks, cast iron", copy=True
    ),
    "brakes_build_up": edit(
        "brakes",
        "scenario.schema_application",
        "LinearApplication.stretches",
        "1.0 / self.time",
        "0.9 / self.time",
        "built up in 4 s: longer by",
        copy=True,
    ),
    "brakes_braked_weight": edit(
        "brakes",
        "wagon.torque",
        "constant_torque",
        "_braking_force(moved_mass(scenario)",
        "_braking_force(total_mass(scenario)",
        "braked weight 65 %",
    ),
    "stopping_table_gradient": edit(
        "stopping-table", "solver.setup", "_line", "0.0 - STANDARD_GRAVITY *", "STANDARD_GRAVITY *", "1 in 100 up"
    ),
    "stopping_table_deceleration": edit(
        "stopping-table",
        "wagon.torque",
        "constant_torque",
        "braking.deceleration * moved_mass",
        "braking.deceleration * total_mass",
        "level / m",
    ),
    "couplings_half": edit(
        "couplings", "solver.setup", "train_problem", "np.diff(places), HALF)", "np.diff(places), 1.0)", "two vehicles"
    ),
    "couplings_damping": edit(
        "couplings", "train.coupling", "_law", "coupling.linear.damping if", "0.5 * coupling.linear.damping if", "chain"
    ),
    "couplings_branches": edit(
        "couplings", "train.coupling", "_law", "return upper, lower, coup", "return lower, upper, coup", "beyond what"
    ),
    "couplings_push": edit(
        "couplings",
        "solver.coupled",
        "put_coupling_forces",
        "(behind - ahead)",
        "(behind - 0.99 * ahead)",
        "chain",
        copy=True,
    ),
    "momentum_reaction": edit(
        "momentum",
        "tank.modal",
        "modal_liquid",
        'share * column("lambda_1")',
        '1.02 * share * column("lambda_1")',
        "momentum lost",
    ),
    "momentum_weight": edit(
        "momentum", "wagon.model", "_weight", "-0.5 * STANDARD_GRAVITY * masses", "-STANDARD_GRAVITY * masses", "weight"
    ),
    "energy_brake_sign": edit(
        "energy", "solver.ledger", "_balance_contacts", "(spin - v[", "(spin + v[", "residual", copy=True
    ),
    "energy_hertz": edit(
        "energy",
        "track.contact",
        "ContactModel.energy",
        "0.4 * self.stiffness",
        "0.5 * self.stiffness",
        "residual",
        copy=True,
    ),
    "energy_spin": edit(
        "energy",
        "wagon.model",
        "_mass_matrix",
        "(wagon.wheelset.spin_inertia,",
        "(2 * wagon.wheelset.spin_inertia,",
        "initial kinetic energy",
    ),
    "second_code_half_liquid": edit(
        "second-code", "solver.setup", "_liquid", "GRAVITY, HALF)", "GRAVITY, 0.5 * HALF)", "slosh amplitude"
    ),
    "figure2_brake_reaction": edit(
        "figure2",
        "solver.contacts",
        "_read_inputs",
        "+= torque[i]",
        "-= torque[i]",
        "leading wheel",
        copy=True,
    ),
    "figure2_pitch_weight": edit(
        "figure2",
        "tank.modal",
        "modal_liquid",
        "pitch_weight=gravity * lambda_1",
        "pitch_weight=0.0 * lambda_1",
        "front bogie",
    ),
    "figure3_friction": edit(
        "figure3",
        "track.contact",
        "contact_model",
        "friction_limit_ratio=adhesion.A",
        "friction_limit_ratio=1.0",
        "longer",
    ),
}


def edited(one: Edit) -> tuple[Any, str, Any]:
    """The owner (module or class), the name, and the function from its edited source."""
    module = import_module(f"slosh_cli.{one.module}")
    *classes, name = one.function.split(".")
    owner: Any = module
    for part in classes:
        owner = getattr(owner, part)
    function = inspect.getattr_static(owner, name)
    source = textwrap.dedent(inspect.getsource(getattr(function, "py_func", function)))
    assert one.old in source, f"{one.function} has no {one.old!r} any more"
    lines = source.replace(one.old, one.new).splitlines()
    text = "\n".join(line for line in lines if line.strip() not in ("@kernel", "@inner_kernel", "@vector_kernel"))
    namespace = dict(vars(module))
    code = compile("from __future__ import annotations\n" + text, f"<sabotaged {one.function}>", "exec")
    exec(code, namespace)
    return owner, name, namespace[name]
