"""Malformed scenarios: keys, units, ranges, types."""

from malformed_case import BASE, Case, Expected, edited, one

# fmt: off
UNKNOWN_KEYS = (
    one(
        "unknown key at the top", "solver: {", "slover: {",
        (49, "slover", "is not a key of a scenario", "`slover`", "write `solver`"),
    ),
    one(
        "unknown key, nested, in place of a required one", "    wheelbase:", "    whelbase:",
        (10, "wagon.bogie.whelbase", "is not a key of `wagon.bogie`", "`whelbase`", "write `wheelbase`"),
    ),
    one(
        "unknown key in a flow mapping over two lines", "shear_damping:", "sheer_damping:",
        (
            36, "track.foundation.sheer_damping", "is not a key of `track.foundation`", "`sheer_damping`",
            "write `shear_damping`",
        ),
    ),
    one(
        "unknown key with hyphens", "pivot_spacing:", "pivot-spacing:",
        (15, "wagon.pivot-spacing", "is not a key of `wagon`", "`pivot-spacing`", "write `pivot_spacing`"),
    ),
    one(
        "unknown key in a list item", "      mu:", "      my:",
        (31, "tank.coefficients.0.my", "is not a key of `tank.coefficients.0`", "`my`", "write `mu`"),
    ),
    one(
        "key of another mapping", "  pivot_spacing: 12 m", "  pivot_spacing: 12 m\n  time_limit: 60 s",
        (16, "wagon.time_limit", "is not a key of `wagon`", "`time_limit`", "take it out"),
    ),
    Case(
        "key one level too high",
        edited(
            ("    wheelbase: 1.8 m\n", ""),
            ("  pivot_spacing: 12 m", "  wheelbase: 1.8 m\n  pivot_spacing: 12 m"),
        ),
        (
            Expected(
                14, "wagon.wheelbase", "is not a key of `wagon`", "`wheelbase`",
                "move it to `wagon.bogie.wheelbase`",
            ),
        ),
    ),
    one(
        "key without any likeness", "  onset: 0.5 s", "  onset: 0.5 s\n  colour: red",
        (
            48, "braking.colour", "is not a key of `braking`", "`colour`",
            "the keys here are initial_speed, torque, blocks, discs, deceleration, braked_weight, application, "
            "load_changeover, slide_protection, onset and stop_speed",
        ),
    ),
    one(
        "dimension of another shape", "  radius: 1.5 m", "  radius: 1.5 m\n  width: 2.4 m",
        (
            23, "tank.width", "tank of shape horizontal-cylinder",
            "belongs to shape rectangular or elliptical", "take it out",
        ),
    ),
)

UNITS = (
    one(
        "mass without unit", "mass: 21.3 t", "mass: 21.3",
        (5, "wagon.car_body.mass", "must be a mass with its unit", "`21.3` without a unit", "write `21.3 t`"),
    ),
    one(
        "speed without unit", "80 km/h", "80",
        (
            45, "braking.initial_speed", "must be a speed with its unit", "`80` without a unit",
            "write `80 km/h` or `80 m/s`",
        ),
    ),
    one(
        "zero without unit", "onset: 0.5 s", "onset: 0",
        (47, "braking.onset", "must be a time with its unit", "`0` without a unit", "write `0 s` or `0 ms`"),
    ),
    one(
        "number in quotes without unit", "onset: 0.5 s", "onset: '0.5'",
        (47, "braking.onset", "must be a time with its unit", "`0.5` without a unit", "write `0.5 s`"),
    ),
    one(
        "exponent without unit, which YAML 1.1 takes for text", "stiffness: 2.6e6 N/m", "stiffness: 2.6e6",
        (
            17, "wagon.primary_suspension.stiffness", "must be a stiffness with its unit", "without a unit",
            "write `2600000.0 N/m`",
        ),
    ),
    one(
        "length where a mass belongs", "    mass: 1.8 t", "    mass: 1.8 m",
        (
            7, "wagon.bogie.mass", "must be a mass with its unit", "`1.8 m`, which is a length",
            "write a number and a unit, such as `1.8 t`",
        ),
    ),
    one(
        "force where a torque belongs", "5 kN m", "5 kN",
        (
            46, "braking.torque", "must be a torque with its unit", "`5 kN`, which is a force",
            "such as `5 kN m`",
        ),
    ),
    one(
        "dimension without a name", "poisson_ratio: 0.3", "poisson_ratio: 0.3\n  stiffness: 9e10 N/m^2.5",
        (
            41, "contact.stiffness", "must be a Hertzian contact stiffness", "which has another dimension",
            "such as `9.4e10 N/m^1.5`",
        ),
    ),
    one(
        "unit in the wrong case", "5 kN m", "5 KN m",
        (
            46, "braking.torque", "must be a torque with its unit", "`KN` is no unit known here",
            "write `5 kN m`",
        ),
    ),
    one(
        "units run together with one of them in the wrong case", "pitch_inertia: 1700 kg m^2",
        "pitch_inertia: 1700 Kgm2",
        (
            8, "wagon.bogie.pitch_inertia", "must be a moment of inertia", "`Kgm` is no unit known here",
            "write `1700 kgm2`",
        ),
    ),
    one(
        "power apart from its unit", "density: 830 kg/m^3", "density: 830 kg/m 3",
        (
            26, "tank.liquid.density", "must be a density with its unit", "`kg/m 3` cannot be read",
            "such as `830 kg/m^3`",
        ),
    ),
    one(
        "pressure where a torque belongs", "5 kN m", "3.8 bar",
        (
            46, "braking.torque", "must be a torque with its unit", "`3.8 bar`, which is a pressure",
            "write a number and a unit, such as `5 kN m`",
        ),
    ),
    one(
        "unit that does not exist", "12 m", "12 parsec",
        (
            15, "wagon.pivot_spacing", "must be a length with its unit", "`parsec` is no unit known here",
            "such as `12 m`",
        ),
    ),
    one(
        "temperature", "    mass: 1.4 t", "    mass: 1.4 degC",
        (
            12, "wagon.wheelset.mass", "must be a mass with its unit", "`degC` is no unit known here",
            "such as `1.4 t`",
        ),
    ),
    one(
        "unit that cannot be parsed", "12 m", "12 m//",
        (15, "wagon.pivot_spacing", "must be a length with its unit", "`m//` cannot be read", "such as `12 m`"),
    ),
    one(
        "comma of thousands or decimals", "    mass: 1.8 t", "    mass: 1,800 kg",
        (
            7, "wagon.bogie.mass", "must be a mass with its unit", "`1,800 kg`, whose comma can part",
            "write `1800 kg` if that is meant",
        ),
    ),
    one(
        "decimal comma in braces", "{mass: 21.3 t,", "{mass: 21,3 t,",
        (
            5, "wagon.car_body.mass", "must be one value, but a comma in braces ends it", "`21,3 t`",
            "write `21.3 t`",
        ),
    ),
    one(
        "comma of thousands in braces", "{mass: 21.3 t,", "{mass: 21,300 kg,",
        (
            5, "wagon.car_body.mass", "must be one value, but a comma in braces ends it", "`21,300 kg`",
            "write `21300 kg` if that is meant",
        ),
    ),
    one(
        "decimal comma of a pure number in braces", "{tolerance: 1.0e-4,", "{tolerance: 0,0001,",
        (
            49, "solver.tolerance", "must be one value, but a comma in braces ends it", "`0,0001`",
            "write `0.0001`",
        ),
    ),
    one(
        "two units for one quantity", "12 m", "12 m 30 cm",
        (
            15, "wagon.pivot_spacing", "must be a length with its unit", "`m 30 cm` cannot be read",
            "such as `12 m`",
        ),
    ),
    one(
        "unit before the number", "12 m", "m 12",
        (
            15, "wagon.pivot_spacing", "must be a length with its unit", "`m 12`",
            "write a finite number and a unit",
        ),
    ),
    one(
        "unit where a plain number belongs", "fill: 0.5", "fill: 1.5 m",
        (24, "tank.fill", "must be a number from 0.02 to 0.995", "`1.5 m`", "number without a unit, such as `0.5`"),
    ),
)

RANGES = (
    one(
        "kilograms where tonnes were meant", "mass: 21.3 t", "mass: 21.3 kg",
        (
            5, "wagon.car_body.mass", "must be a mass from 500 kg to 200000 kg", "`21.3 kg`",
            "such as `21.3 t`, or is its unit meant to be `t`?",
        ),
    ),
    one(
        "millimetres where metres were meant", "0.46 m", "0.46 mm",
        (
            14, "wagon.wheelset.wheel_radius", "must be a length from 0.1 m to 1.5 m",
            "`0.46 mm` = 0.00046 m", "or is its unit meant to be `m`?",
        ),
    ),
    one(
        "negative torque", "5 kN m", "-5 kN m",
        (
            46, "braking.torque", "must be a torque from 0 N m to 1e6 N m", "`-5 kN m` = -5000 N m",
            "write a value within the range, such as `5 kN m`",
        ),
    ),
    one(
        "overfull tank", "fill: 0.5", "fill: 1.0",
        (24, "tank.fill", "must be a number from 0.02 to 0.995", "`1`", "such as `0.5`"),
    ),
    one(
        "fill in per cent", "fill: 0.5", "fill: 50",
        (24, "tank.fill", "must be a number from 0.02 to 0.995", "`50`", "such as `0.5`, or is it meant in `%`?"),
    ),
    one(
        "tolerance of zero", "1.0e-4", "0",
        (49, "solver.tolerance", "must be a number from 1e-8 to 0.01", "`0`", "such as `1e-4`"),
    ),
    one(
        "Poisson's ratio of a half", "poisson_ratio: 0.3", "poisson_ratio: 0.5",
        (40, "contact.poisson_ratio", "must be a number from 0 and below 0.5", "`0.5`", "such as `0.3`"),
    ),
    one(
        "modal mass of zero", "442163 kg", "0 kg",
        (31, "tank.coefficients.0.mu", "must be a mass above 0 kg", "`0 kg`", "such as `442163 kg`"),
    ),
    one(
        "no coupling", "lambda_1: 137071 kg", "lambda_1: 0 t",
        (29, "tank.coefficients.0.lambda_1", "must not be zero", "`0 t`", "such as `137071 kg`"),
    ),
    one(
        "aircraft speed", "80 km/h", "800 km/h",
        (
            45, "braking.initial_speed", "must be a speed from 0.01 m/s to 150 m/s",
            "`800 km/h` = 222.222 m/s", "write a value within the range",
        ),
    ),
    one(
        "number too large for a float", "12 m", "1e999 m",
        (15, "wagon.pivot_spacing", "must be a length", "`1e999 m`, which overflows", "write a finite number"),
    ),
    one(
        "nan", "kalker_c11: 4.12", "kalker_c11: .nan",
        (42, "contact.kalker_c11", "must be a number from 0.1 to 100", "`nan`", "write a finite number"),
    ),
    one(
        "infinity", "kalker_c11: 4.12", "kalker_c11: .inf",
        (42, "contact.kalker_c11", "must be a number from 0.1 to 100", "`inf`", "write a finite number"),
    ),
    one(
        "nan with a unit", "onset: 0.5 s", "onset: nan s",
        (47, "braking.onset", "must be a time with its unit", "`nan s`", "write a finite number and a unit"),
    ),
    one(
        "infinite quantity", "onset: 0.5 s", "onset: .inf",
        (47, "braking.onset", "must be a time with its unit", "`inf`", "write a finite number and a unit"),
    ),
    one(
        "half a mode", "  coefficients:", "  modes: 1.5\n  coefficients:",
        (27, "tank.modes", "must be a whole number from 1 to 20", "`1.5`", "such as `1`"),
        (
            27, "tank.modes", "must not be set where the slosh coefficients are given", "beside a list",
            "leave `modes` out",
        ),
    ),
)

SHAPES_AND_TYPES = (
    one(
        "truth value for a quantity", "onset: 0.5 s", "onset: true",
        (
            47, "braking.onset", "must be a time with its unit", "`true`, which is a truth value",
            "write a number and a unit",
        ),
    ),
    one(
        "truth value for a number", "fill: 0.5", "fill: false",
        (
            24, "tank.fill", "must be a number", "`false`, which is a truth value",
            "write a number, such as `0.5`",
        ),
    ),
    one(
        "number in quotes", "poisson_ratio: 0.3", "poisson_ratio: '0.3'",
        (40, "contact.poisson_ratio", "must be a number", "the text `'0.3'`", "without quotes: `0.3`"),
    ),
    one(
        "text for a number", "poisson_ratio: 0.3", "poisson_ratio: steel",
        (40, "contact.poisson_ratio", "must be a number", "`steel`", "write a number, such as `0.3`"),
    ),
    one(
        "nothing for a quantity", "12 m", "",
        (15, "wagon.pivot_spacing", "must be a length with its unit", "nothing", "write a number and a unit"),
    ),
    one(
        "number for a name", "name: example", "name: 80",
        (2, "name", "must be text of at most 100 characters", "`80`", 'write it in quotes: `"80"`'),
    ),
    one(
        "name that leaves its folder", "name: example", "name: ../../etc",
        (2, "name", "can name a folder", "`../../etc`", "write `etc`"),
    ),
    one(
        "list for a text", "description: A wagon to break", "description: [a, b]",
        (3, "description", "must be text", "a list of 2", "write text"),
    ),
    one(
        "scalar for a mapping",
        "  car_body: {mass: 21.3 t, pitch_inertia: 4.6e5 kg m^2, centre_height: 2.2 m}", "  car_body: 21.3 t",
        (
            5, "wagon.car_body", "must be a mapping with the keys mass, pitch_inertia and centre_height",
            "`21.3 t`", "write these keys under `car_body:`",
        ),
    ),
    one(
        "nothing for a mapping", "solver: {tolerance: 1.0e-4, time_limit: 600 s}", "solver:",
        (
            49, "solver", "must be a mapping with the keys tolerance and time_limit", "nothing",
            "write these keys under `solver:`",
        ),
    ),
    one(
        "list for a mapping", "output: {interval: 10 ms}", "output:\n  - interval: 10 ms",
        (
            50, "output", "must be a mapping with the keys interval", "a list of 1",
            "write these keys under `output:`",
        ),
    ),
    one(
        "mapping for a scalar", "  onset: 0.5 s", "  onset: {value: 0.5, unit: s}",
        (
            47, "braking.onset", "must be a time with its unit", "a mapping",
            "write a number and a unit, such as `0.5 s`",
        ),
    ),
    one(
        "list for a scalar", "  onset: 0.5 s", "  onset: [0.5 s]",
        (47, "braking.onset", "must be a time with its unit", "a list of 1", "write a number and a unit"),
    ),
    one(
        "scalar for an item of a list",
        "    - frequency: 0.69 rad/s\n      lambda_1: 137071 kg\n      lambda_02: -68461 kg m\n      mu: "
        "442163 kg",
        "    - 0.69 rad/s",
        (
            28, "tank.coefficients.0", "must be a mapping with the keys frequency, lambda_1", "`0.69 rad/s`",
            "write the item as `{frequency: ..., lambda_1",
        ),
    ),
    one(
        "mapping for a list", "    - frequency:", "      frequency:",
        (
            27, "tank.coefficients", "must be `computed` or a list of slosh modes", "a mapping",
            "`- {frequency: ...",
        ),
    ),
    one(
        "tank as a word",
        BASE[BASE.index("tank:"):BASE.index("track:")],
        "tank: cylinder\n",
        (20, "tank", "must be a mapping", "`cylinder`", "such as `shape: horizontal-cylinder`"),
    ),
    one(
        "missing quantity", "    wheel_radius: 0.46 m\n", "",
        (
            11, "wagon.wheelset.wheel_radius", "is required", "nothing",
            "such as `wheel_radius: 0.46 m` or `wheel_diameter: 0.92 m`",
        ),
    ),
    one(
        "missing mapping",
        "  primary_suspension: {stiffness: 2.6e6 N/m, damping: 1.5e4 N s/m}\n",
        "",
        (
            4, "wagon.primary_suspension", "is required", "nothing",
            "write `primary_suspension:` with the keys stiffness and damping",
        ),
    ),
    one(
        "missing adhesion", "  adhesion: dry\n", "  adhesion:\n",
        (43, "contact.adhesion", "must be `dry`, `wet`, a coefficient", "nothing", "such as `0.15`"),
    ),
    one("missing version", "format: 1\n", "", (1, "format", "is required", "nothing", "write `format: 1`")),
    one(
        "missing in a list item", "      mu: 442163 kg\n", "",
        (28, "tank.coefficients.0.mu", "is required", "nothing", "such as `mu: 442163 kg`"),
    ),
    one(
        "missing shape", "  shape: horizontal-cylinder\n", "",
        (
            20, "tank.shape", "is required", "nothing",
            "write `shape: horizontal-cylinder`, `shape: rectangular`",
        ),
    ),
    one(
        "missing height of the tank on its wagon", "  bottom_height: 1.15 m\n", "",
        (
            20, "tank.bottom_height", "is required for a tank on a wagon", "nothing",
            "above the rail head, such as `bottom_height: 1.15 m`",
        ),
    ),
    Case(
        "a tank alone where a stop is asked for",
        "format: 1\nname: alone\n" + BASE[BASE.index("tank:"):BASE.index("track:")],
        (
            Expected(
                1, "", "must describe a stop, with wagon, braking beside the tank",
                "a tank alone", "add them",
            ),
        ),
    ),
)
# fmt: on
