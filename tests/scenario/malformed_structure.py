"""Malformed scenarios: repeated keys, words to choose from, outlines, rules between values."""

from malformed_case import one, polygon

# fmt: off
DUPLICATES = (
    one(
        "duplicate key at the top", "output: {", "name: twice\noutput: {",
        (50, "name", "must be given once", "`name` on lines 2 and 50", "keep one of them"),
    ),
    one(
        "duplicate key, nested", "    wheelbase: 1.8 m", "    wheelbase: 1.8 m\n    mass: 2 t",
        (11, "wagon.bogie.mass", "must be given once", "`mass` on lines 7 and 11", "keep one of them"),
    ),
    one(
        "duplicate key in a flow mapping", "damping: 1.5e4 N s/m}",
        "damping: 1.5e4 N s/m, stiffness: 1 MN/m}",
        (
            17, "wagon.primary_suspension.stiffness", "must be given once", "`stiffness` on lines 17 and 17",
            "keep one of them",
        ),
    ),
    one(
        "duplicate key in a list item", "      mu: 442163 kg", "      mu: 442163 kg\n      mu: 442163 kg",
        (32, "tank.coefficients.0.mu", "must be given once", "`mu` on lines 31 and 32", "keep one of them"),
    ),
    one(
        "duplicate mapping", "output: {", "braking: {torque: 9 kN m}\noutput: {",
        (50, "braking", "must be given once", "`braking` on lines 44 and 50", "keep one of them"),
    ),
)

CHOICES = (
    one(
        "unknown version", "format: 1", "format: 2",
        (1, "format", "must be 1, the only scenario format this version reads", "`2`", "write `1`"),
    ),
    one("version as text", "format: 1", "format: one", (1, "format", "must be 1", "`one`", "write `1`")),
    one(
        "shape misspelt", "horizontal-cylinder", "horizontal_cilinder",
        (
            21, "tank.shape", "must be `horizontal-cylinder`, `rectangular`, `elliptical` or `polygon`",
            "`horizontal_cilinder`", "write `horizontal-cylinder`",
        ),
    ),
    one(
        "shape unknown", "horizontal-cylinder", "teapot",
        (
            21, "tank.shape", "must be `horizontal-cylinder`", "`teapot`",
            "write `horizontal-cylinder`, `rectangular`",
        ),
    ),
    one(
        "shape as a list", "horizontal-cylinder", "[rectangular]",
        (21, "tank.shape", "must be `horizontal-cylinder`", "a list of 1", "write `horizontal-cylinder`"),
    ),
    one(
        "liquid model misspelt", "model: modal", "model: rigit",
        (26, "tank.liquid.model", "must be `rigid`, `modal` or `shallow-water`", "`rigit`", "write `rigid`"),
    ),
    one(
        "liquid model half remembered", "model: modal", "model: shallow",
        (26, "tank.liquid.model", "must be `rigid`, `modal` or `shallow-water`", "`shallow`", "write `shallow-water`"),
    ),
    one(
        "adhesion misspelt", "adhesion: dry", "adhesion: Wett",
        (
            43, "contact.adhesion",
            "must be `dry`, `wet`, a coefficient of friction from 0.005 to 1.5 or a mapping of mu0, A, B, kA and kS",
            "`Wett`", "write `wet`",
        ),
    ),
    one(
        "adhesion as a number out of range", "adhesion: dry", "adhesion: 30",
        (43, "contact.adhesion", "must be `dry`, `wet`, a coefficient", "`30`", "within the range, such as `0.55`"),
    ),
    one(
        "adhesion as another word", "adhesion: dry", "adhesion: ice",
        (43, "contact.adhesion", "must be `dry`, `wet`, a coefficient", "`ice`", "such as `0.15` or `{mu0: 0.55"),
    ),
    one(
        "adhesion, own, incomplete", "adhesion: dry", "adhesion: {mu0: 0.3, A: 0.4, B: 0.2, kA: 0.3}",
        (
            43, "contact.adhesion.B", "must be an inverse speed with its unit", "`0.2` without a unit",
            "write `0.2 s/m`",
        ),
        (43, "contact.adhesion.kS", "is required", "nothing", "such as `kS: 0.4`"),
    ),
    one(
        "coefficients misspelt",
        "  coefficients:\n    - frequency: 0.69 rad/s\n      lambda_1: 137071 kg\n      lambda_02: -68461 "
        "kg m\n      mu: 442163 kg",
        "  coefficients: compute",
        (
            27, "tank.coefficients", "must be `computed` or a list of slosh modes", "`compute`",
            "write `computed`",
        ),
    ),
    one(
        "no coefficients",
        "  coefficients:\n    - frequency: 0.69 rad/s\n      lambda_1: 137071 kg\n      lambda_02: -68461 "
        "kg m\n      mu: 442163 kg",
        "  coefficients: []",
        (27, "tank.coefficients", "a list of at least one slosh mode", "a list of 0", "write `computed`, or"),
    ),
)

POLYGONS = (
    polygon(
        "polygon with two corners", "points: [[0, 0], [1, 1]]", "must have at least three corners", "2",
        "write",
    ),
    polygon("polygon as a word", "points: round", "must be a list of corners", "`round`", "such as `points:"),
    polygon(
        "polygon with a corner of three numbers", "points: [[-1, 0], [1, 0, 0], [1, 2], [-1, 2]]",
        "corner 2 is not", "a list of 3", "write the corner as `[y, z]`",
    ),
    polygon(
        "polygon with a word in a corner", "points: [[-1, 0], [1, zero], [1, 2], [-1, 2]]",
        "coordinates in m within 20 m, but corner 2 has not", "`zero`", "write a finite number",
    ),
    polygon(
        "polygon in millimetres", "points: [[-1200, 0], [1200, 0], [1200, 2000], [-1200, 2000]]",
        "coordinates in m within 20 m, but corner 1 has not", "`-1200`", "write a number of metres",
    ),
    polygon(
        "polygon that crosses itself", "points: [[-1, 0], [1, 0], [-1, 2], [1, 2]]",
        "must not cross or touch itself", "side 2, [1, 0] to [-1, 2], meeting side 4, [1, 2] to [-1, 0]",
        "in order",
    ),
    polygon(
        "polygon that folds back", "points: [[-1, 0], [1, 0], [0, 0], [0, 2]]",
        "must not cross or touch itself", "side 1", "list the corners in order",
    ),
    polygon(
        "polygon with a repeated corner", "points: [[-1, 0], [1, 0], [1, 0], [1, 2], [-1, 2]]",
        "must have corners apart from each other", "corners 2 and 3 at [1, 0]", "leave one of them out",
    ),
    polygon(
        "polygon off its bottom", "points: [[-1, 0.5], [1, 0.5], [1, 2], [-1, 2]]",
        "must have its lowest point at z = 0", "a lowest z of 0.5 m", "take 0.5 off every z",
    ),
    polygon(
        "polygon off its middle", "points: [[0, 0], [2, 0], [2, 2], [0, 2]]", "must be symmetric about y = 0",
        "corner [2, 0] without its mirror image", "write a corner [-2, 0] too",
    ),
)

CROSS_RULES = (
    one(
        "stop speed above the start", "0.02 m/s", "90 km/h",
        (
            48, "braking.stop_speed", "must be below the initial speed, 22.2222 m/s", "`25 m/s`",
            "write a lower stop speed",
        ),
    ),
    one(
        "bogies on top of each other", "12 m", "1.7 m",
        (
            15, "wagon.pivot_spacing", "must be longer than the wheelbase of a bogie, 1.8 m", "`1.7 m`",
            "write a longer",
        ),
        (23, "tank.length", "must be at most 3 pivot spacings, 5.1 m", "`15.5 m`", "write a shorter tank"),
    ),
    one(
        "wheels on top of each other", "    wheelbase: 1.8 m", "    wheelbase: 0.9 m",
        (
            10, "wagon.bogie.wheelbase", "must be longer than the wheels are high, 0.92 m", "`0.9 m`",
            "write a longer",
        ),
        (
            37, "track.domain.element_length", "must be at most half the wheelbase, 0.45 m", "`0.5 m`",
            "write `0.45 m`",
        ),
    ),
    one(
        "domain too short", "length: 50 m", "length: 20 m",
        (
            37, "track.domain.length", "must hold the wheels, 13.8 m apart, and 5 m more at either end",
            "`20 m`", "write at least `23.8 m`",
        ),
    ),
    one(
        "slot wider than a fifth of the tank", "liquid: {model: modal,",
        "liquid: {model: shallow-water, slot_speed: 8 m/s,",
        (
            26, "tank.liquid.slot_speed", "must be at least 12.1", "`8 m/s`", "write `30 m/s` or more",
        ),
    ),
    one(
        "elements too many", "{length: 50 m, element_length: 0.5 m}", "{length: 500 m, element_length: 1 cm}",
        (
            37, "track.domain.element_length", "must give at most 20000 elements over 500 m", "`0.01 m`",
            "write `0.025 m` or more",
        ),
    ),
    one(
        "elements too long", "element_length: 0.5 m", "element_length: 1 m",
        (
            37, "track.domain.element_length", "must be at most half the wheelbase, 0.9 m", "`1 m`",
            "write `0.9 m` or less",
        ),
    ),
    one(
        "kS above kA", "adhesion: dry",
        "adhesion:\n    {mu0: 0.3, A: 0.4, B: 0.2 s/m,\n     kA: 0.1, kS: 0.3}",
        (45, "contact.adhesion.kS", "must be at most kA, 0.1", "`0.3`", "write `0.1` or less"),
    ),
    one(
        "onset after the end", "onset: 0.5 s", "onset: 11 min",
        (
            47, "braking.onset", "must come before the solver's time limit, 600 s", "`660 s`",
            "write an earlier onset",
        ),
    ),
    one(
        "history too long", "interval: 10 ms", "interval: 0.1 ms",
        (50, "output.interval", "must give at most 2000000 rows", "`0.0001 s`", "write `0.0003 s` or more"),
    ),
    one(
        "modes beside coefficients", "  coefficients:", "  modes: 3\n  coefficients:",
        (
            27, "tank.modes", "must not be set where the slosh coefficients are given", "`3` beside a list",
            "leave `modes` out, or write `coefficients: computed`",
        ),
    ),
    one(
        "damping that would not be used", "density: 830 kg/m^3", "density: 830 kg/m^3, damping_ratio: 0.01",
        (
            26, "tank.liquid.damping_ratio", "must not be set where the slosh coefficients are given",
            "`0.01` beside a list", "give each mode its own `damping_ratio`",
        ),
    ),
    one(
        "tank through the bridge", "bottom_height: 1.15 m", "bottom_height: 4.5 m",
        (
            22, "tank.radius", "must fit on a wagon: its top at most 7 m above the rail head",
            "a top at `7.5 m`", "write a lower tank or `bottom_height`",
        ),
    ),
    one(
        "tank wider than the line", "radius: 1.5 m", "radius: 2.6 m",
        (
            22, "tank.radius", "must fit on a wagon: at most 5 m wide", "a width of `5.2 m`",
            "write a narrower tank",
        ),
    ),
    one(
        "tank longer than the wagon", "length: 15.5 m", "length: 40 m",
        (23, "tank.length", "must be at most 3 pivot spacings, 36 m", "`40 m`", "write a shorter tank"),
    ),
)
# fmt: on
