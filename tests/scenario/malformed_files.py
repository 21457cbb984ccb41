"""Malformed scenarios: files and YAML that cannot be read, overrides, several mistakes at once."""

from malformed_case import BASE, Case, Expected, edited, one, override

TORQUE = "--set braking.torque"

# fmt: off
YAML_SYNTAX = (
    one(
        "indented with a tab", "  torque: 5 kN m", "\ttorque: 5 kN m",
        (46, "", "must be valid YAML", "character '\\t'", "indent with spaces, not tabs"),
    ),
    one(
        "flow mapping left open", "damping: 1.5e4 N s/m}", "damping: 1.5e4 N s/m",
        (18, "", "must be valid YAML", "begun on line 17", "close what was opened"),
    ),
    one(
        "quote left open", "description: A wagon", "description: 'A wagon",
        (51, "", "must be valid YAML", "begun on line 3", "close what was opened"),
    ),
    one(
        "colon in a text", "description: A wagon", "description: A wagon: one",
        (3, "", "must be valid YAML", "mapping values are not allowed here", "check colons"),
    ),
    one(
        "no space after the colon", "  onset: 0.5 s", "  onset:0.5 s",
        (48, "", "must be valid YAML", "could not find expected ':'", "check colons"),
    ),
    one(
        "wrong indentation", "  onset: 0.5 s", "   onset: 0.5 s",
        (
            47, "", "must be valid YAML", "mapping values are not allowed here",
            "check colons, quotes and indentation",
        ),
    ),
    one(
        "alias without anchor", "adhesion: dry", "adhesion: *wet",
        (43, "", "must be valid YAML", "undefined alias", "define the anchor"),
    ),
    one(
        "alias that contains itself", "output: {interval: 10 ms}", "output: &loop {interval: *loop}",
        (50, "output.interval", "must be a tree", "an alias that contains itself", "write the values out"),
        (50, "output.interval", "must be a time with its unit", "nothing", "write a number and a unit"),
    ),
    one(
        "tag", "description: A wagon to break", "description: !!python/object/apply:os.system [ls]",
        (3, "description", "must be plain text, number, list or mapping", "os.system", "leave out the tag"),
        (3, "description", "must be text", "nothing", "write text"),
    ),
    one(
        "merge of what is no mapping", "output: {interval: 10 ms}", "output: {<<: 3, interval: 10 ms}",
        (50, "output.<<", "must be an alias of another mapping", "something else", "write `<<: *name`"),
    ),
    one(
        "duplicate key in a merged mapping", "{interval: 10 ms}", "{<<: {interval: 1 ms, interval: 2 ms}}",
        (50, "output.interval", "must be given once", "on lines 50 and 50", "keep one of them"),
    ),
    one(
        "list as a key", "output: {interval: 10 ms}", "output: {[a, b]: 3, interval: 10 ms}",
        (50, "output", "must have words as keys", "a list or mapping", "write a word"),
    ),
    one(
        "two scenarios in a file", "contact:\n", "---\ncontact:\n",
        (38, "", "must be valid YAML", "another document", "write one scenario per file"),
    ),
    one(
        "control character", "description: A wagon", "description: A \x07 wagon",
        (3, "", "must be valid YAML", "control character", "take it out"),
    ),
    Case(
        "nested too deeply",
        "[" * 5000 + "]" * 5000,
        (Expected(None, "", "must be valid YAML", "nested too deeply", "write the values out"),),
    ),
)

FILES = (
    Case("no such file", None, (Expected(None, "", "must exist", "a path with no file", "`slosh init`"),)),
    Case(
        "folder", None,
        (Expected(None, "", "must be a file", "a folder", "name the scenario file"),),
        folder=True,
    ),
    Case("empty file", "", (Expected(None, "", "must be a mapping", "an empty file", "`slosh init`"),)),
    Case(
        "only comments", "# nothing\n\n",
        (Expected(None, "", "must be a mapping", "an empty file", "`slosh init`"),),
    ),
    Case(
        "a list", "\n- 1\n- 2\n",
        (Expected(2, "", "must be a mapping", "a list of 2", "write `format: 1`"),),
    ),
    Case("a word", "paper-80\n", (Expected(1, "", "must be a mapping", "`paper-80`", "write `format: 1`"),)),
    Case(
        "not UTF-8",
        edited(("A wagon", "Ein Kesselwagen für")).encode("latin-1"),
        (Expected(3, "", "must be text in UTF-8", "byte 0xfc", "save the file as UTF-8"),),
    ),
    Case(
        "UTF-16",
        BASE.encode("utf-16"),
        (Expected(1, "", "must be text in UTF-8", "byte 0xff at position 0", "save the file as UTF-8"),),
    ),
    Case(
        "too long",
        BASE + "# " + "x" * 1000000,
        (Expected(None, "", "must have at most 1000000 bytes", "more than", "name a scenario file"),),
    ),
)

OVERRIDES = (
    override(
        "override of an unknown key", "braking.torq=12 kN m",
        expected=(
            ("--set braking.torq", "braking.torq", "is not a key of `braking`", "`torq`", "write `torque`"),
        ),
    ),
    override(
        "override under an unknown key", "brakes.torque=12 kN m",
        expected=(
            ("--set brakes.torque", "brakes", "is not a key of a scenario", "`brakes`", "write `braking`"),
        ),
    ),
    override(
        "override without a sign", "braking.torque",
        expected=(
            (
                TORQUE,
                "", "must be a key path, an equals sign and a value", "`braking.torque`", "write it like",
            ),
        ),
    ),
    override(
        "override with an empty key", "=12 kN m",
        expected=(("--set =12 kN m", "", "must be a key path", "`=12 kN m`", "write it like"),),
    ),
    override(
        "override with a gap in its path", "braking..torque=12 kN m",
        expected=(
            ("--set braking..torque=12 kN m", "", "must be a key path", "`braking..torque=12 kN m`", "write"),
        ),
    ),
    override(
        "override without a unit", "braking.torque=12",
        expected=(
            (
                TORQUE,
                "braking.torque", "must be a torque with its unit", "`12` without a unit", "write `12 kN m`",
            ),
        ),
    ),
    override(
        "override with a bad unit", "braking.torque=12 kX m",
        expected=(
            (TORQUE, "braking.torque", "must be a torque", "`kX` is no unit known here", "such as `5 kN m`"),
        ),
    ),
    override(
        "override with nothing", "braking.torque=",
        expected=(
            (
                TORQUE,
                "braking.torque", "must be a torque with its unit", "nothing", "write a number and a unit",
            ),
        ),
    ),
    override(
        "override out of range", "tank.fill=1.2",
        expected=(
            ("--set tank.fill", "tank.fill", "must be a number from 0.02 to 0.995", "`1.2`", "such as `0.5`"),
        ),
    ),
    override(
        "override that is no YAML", "contact.adhesion={mu0: 0.3",
        expected=(
            ("--set contact.adhesion", "contact.adhesion", "must be valid YAML", "expected", "close what"),
        ),
    ),
    override(
        "override with a duplicate key", "output={interval: 1 ms, interval: 2 ms}",
        expected=(
            ("--set output", "output.interval", "must be given once", "`interval` again", "keep one of them"),
        ),
    ),
    override(
        "override of a mapping with a mistake in it", "output={interval: 5}",
        expected=(
            ("--set output", "output.interval", "must be a time with its unit", "`5` without a unit", "write `5 s`"),
        ),
    ),
    override(
        "override with a line end in it", r'braking.torque="kN\n12"',
        expected=((TORQUE, "braking.torque", "must be a torque with its unit", "`kN\n12`", "write a finite number"),),
    ),
    override(
        "override into a list item", "tank.coefficients.0.mu=-3 kg",
        expected=(
            (
                "--set tank.coefficients.0.mu", "tank.coefficients.0.mu", "must be a mass above 0 kg",
                "`-3 kg`", "such as `442163 kg`",
            ),
        ),
    ),
    override(
        "override of a list item that is not there", "tank.coefficients.1.mu=3 kg",
        expected=(
            (
                "--set tank.coefficients.1.mu", "tank.coefficients.1.mu",
                "must name an item of the list `tank.coefficients` by its number from 0 to 0", "`1`",
                "write `tank.coefficients.0`",
            ),
        ),
    ),
    override(
        "override of a list item by a word", "tank.coefficients.mu=3 kg",
        expected=(
            (
                "--set tank.coefficients.mu", "tank.coefficients.mu", "must name an item of the list", "`mu`",
                "write `tank.coefficients.0`",
            ),
        ),
    ),
    override(
        "override below a single value", "braking.torque.value=3 kN m",
        expected=(
            (
                "--set braking.torque.value", "braking.torque.value",
                "must lead through mappings, but `braking.torque` is a single value", "`5 kN m`",
                "give `braking.torque` as a whole",
            ),
        ),
    ),
    override(
        "override of a mapping by a word", "track.rail=UIC60",
        expected=(
            (
                "--set track.rail", "track.rail", "must be a mapping with the keys youngs_modulus", "`UIC60`",
                "write these keys",
            ),
        ),
    ),
    override(
        "override of the version", "format=2",
        expected=(("--set format", "format", "must be 1", "`2`", "write `1`"),),
    ),
    Case(
        "override that breaks a rule with a line of the file",
        BASE,
        (
            Expected(
                48, "braking.stop_speed", "must be below the initial speed, 0.02 m/s", "`0.02 m/s`",
                "a higher `braking.initial_speed`",
            ),
        ),
        ("braking.initial_speed=0.02 m/s",),
    ),
    override(
        "override that breaks a rule of two values", "track.domain.length=10 m",
        expected=(
            (
                "--set track.domain.length", "track.domain.length", "must hold the wheels", "`10 m`",
                "write at least",
            ),
        ),
    ),
    Case(
        "switch of shape that leaves a key behind",
        BASE,
        (
            Expected(
                22, "tank.radius", "is not a key of a tank of shape rectangular",
                "`radius`, which belongs to shape horizontal-cylinder", "take it out",
            ),
        ),
        ("tank.shape=rectangular", "tank.width=2.4 m", "tank.height=2 m", "tank.coefficients=computed"),
    ),
    Case(
        "override that completes no mapping",
        edited(("solver: {tolerance: 1.0e-4, time_limit: 600 s}\n", "")),
        (
            Expected(
                None, "solver.tolerance", "must be a number", "`tight`", "write a number",
                "--set solver.tolerance",
            ),
        ),
        ("solver.tolerance=tight",),
    ),
)

SEVERAL = (
    Case(
        "everything at once",
        edited(
            ("mass: 21.3 t", "mass: 21.3 kg"),
            ("    wheelbase: 1.8 m", "    wheelbase: 1.8 t"),
            ("fill: 0.5", "fill: 0.5\n  fill: 0.6"),
            ("    - frequency: 0.69 rad/s", "    - frequenzy: 0.69 rad/s"),
            ("length: 50 m", "length: 50"),
            ("adhesion: dry", "adhesion: dri"),
            ("0.02 m/s", "100 km/h"),
        ),
        (
            Expected(5, "wagon.car_body.mass", "must be a mass from 500 kg", "`21.3 kg`", "such as `21.3 t`"),
            Expected(10, "wagon.bogie.wheelbase", "must be a length", "which is a mass", "such as `1.8 m`"),
            Expected(25, "tank.fill", "must be given once", "on lines 24 and 25", "keep one"),
            Expected(29, "tank.coefficients.0.frequenzy", "is not a key", "`frequenzy`", "write `frequency`"),
            Expected(38, "track.domain.length", "must be a length", "`50` without a unit", "write `50 m`"),
            Expected(44, "contact.adhesion", "must be `dry`, `wet`", "`dri`", "write `dry`"),
            Expected(
                49, "braking.stop_speed", "must be below the initial speed", "`27.7778 m/s`", "write a lower",
            ),
        ),
    ),
    Case(
        "file and overrides at once",
        edited(("0.46 m", "0.46")),
        (
            Expected(
                14, "wagon.wheelset.wheel_radius", "must be a length", "`0.46` without a unit",
                "write `0.46 m`",
            ),
            Expected(
                None, "braking.torque", "must be a torque", "`12 kN`, which is a force", "such as `5 kN m`",
                TORQUE,
            ),
            Expected(None, "tank.shpe", "is not a key of a tank", "`shpe`", "`shape`", "--set tank.shpe"),
        ),
        ("braking.torque=12 kN", "tank.shpe=polygon"),
    ),
    Case(
        "misspelt shape does not hide what else is wrong with the tank",
        edited(("horizontal-cylinder", "cylinder"), ("radius: 1.5 m", "radius: 1.5")),
        (
            Expected(
                21, "tank.shape", "must be `horizontal-cylinder`", "`cylinder`",
                "write `horizontal-cylinder`",
            ),
            Expected(22, "tank.radius", "must be a length", "`1.5` without a unit", "write `1.5 m`"),
        ),
    ),
)
# fmt: on
