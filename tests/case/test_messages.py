"""Every fault of a case is one line with file, key and what to do."""

import pytest
from drafts import WATER, refusal

from psph.case.messages import plain

BOX = "shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }"
PROBE = "\n[probes.P1]\nposition = [0.5, 0.1]\n"


def replaced(old: str, new: str) -> str:
    """WATER with a part exchanged."""
    assert old in WATER
    return WATER.replace(old, new)


FAULTS = {
    "a typing error in a key": (
        WATER + "viscocity = 1.0",
        "fluids.water.viscocity: unknown key; did you mean 'viscosity'?",
    ),
    "a typing error in upper case": (
        replaced("spacing", "Spacings"),
        "space.Spacings: unknown key; did you mean 'spacing'?",
    ),
    "a table whose name is a part of the right one": (
        WATER + "[gases.hot]\ndensity = 1.0\n",
        "gases: unknown key; did you mean 'ideal_gases'?",
    ),
    "a number in the place of a table": (
        replaced("[physics]\n", "[physics]\nself_gravity = 1.0\n"),
        "physics.self_gravity.softening: missing; add softening = ...",
    ),
    "a key that resembles none": (
        replaced("end = 2.0", "end = 2.0\nqqq = 1"),
        "time.qqq: unknown key; known here: end, cfl, passes, lead, gather_every, damping_every, halvings, step",
    ),
    "a key below the wrong table": (
        WATER + "end = 1.0\n",
        "fluids.water.end: unknown key; did you mean time.end? A key below a [table] belongs to that table",
    ),
    "a key of another kind of table": (
        WATER + "[probes.a]\nviscosity = 1.0\n",
        "probes.a.viscosity: unknown key; did you mean fluids.NAME.viscosity? A key below a [table]",
    ),
    "a table below another": (
        WATER + "[fluids.water.physics]\n",
        "fluids.water.physics: unknown key; did you mean physics? A key below a [table]",
    ),
    "a kernel elsewhere, and none of that name": (
        WATER.replace("[physics]", '[physics]\nkernel = "wendland"'),
        "physics.kernel: unknown key; did you mean space.kernel? A key below a [table] belongs to that table; "
        "and \"wendland\" is not known there: did you mean 'wendland-c2' or 'wendland-c4' or 'wendland-c6'?",
    ),
    "a kernel elsewhere": (
        WATER.replace("[physics]", '[physics]\nkernel = "cubic"'),
        "physics.kernel: unknown key; did you mean space.kernel? A key below a [table] belongs to that table",
    ),
    "an unknown table": (WATER + "[fluid.oil]\n", "fluid: unknown key; did you mean 'fluids'?"),
    "an unknown effect": (
        replaced("[physics]", "[physics]\nfreesurface = 0.9"),
        "physics.freesurface: unknown key; did you mean 'free_surface'?",
    ),
    "an unknown parameter": (
        replaced("[physics]", "[physics]\nartificial_viscosity = { alpa = 1.0 }"),
        "physics.artificial_viscosity.alpa: unknown key; did you mean 'alpha'?",
    ),
    "an unknown form": (
        replaced("shape.box", "shape.bix"),
        "fluids.water.shape.bix: unknown key; did you mean 'box'?",
    ),
    "a missing key": (
        replaced("spacing = 0.1", ""),
        "space.spacing: missing; add spacing = ... (distance between particles at the start, m)",
    ),
    "a missing table": (
        replaced("[time]\nend = 2.0", ""),
        "time: missing; add the table [time] (simulated time and time steps)",
    ),
    "no fluid": (
        WATER[: WATER.index("[fluids")],
        "fluids: missing; add a table [fluids.NAME] (the fluids by name",
    ),
    "a body without a fluid": (
        WATER[: WATER.index("[fluids")]
        + "[bodies.box]\nshape.box = { lower = [0.0], upper = [1.0] }\nmass = 1.0",
        "bodies: rigid bodies need a fluid or an elastic solid; add a table [fluids.NAME]",
    ),
    "an empty table of fluids": (
        WATER[: WATER.index("[fluids")] + "[fluids]",
        "fluids: empty; add a table [fluids.NAME]",
    ),
    "too many walls": (
        WATER + "".join(f"[walls.w{k}]\n{BOX}\n" for k in range(101)),
        "walls: too many; at most 100",
    ),
    "a text for a number": (
        replaced("end = 2.0", 'end = "2.0"'),
        'time.end: "2.0" is not a number; give a number (simulated time',
    ),
    "a boolean for a number": (
        replaced("end = 2.0", "end = true"),
        "time.end: true is not a number; give a number (simulated time at which the run ends, s)",
    ),
    "a date for a number": (
        replaced("end = 2.0", "end = 2001-01-01"),
        "time.end: 2001-01-01 is not a number; give a number",
    ),
    "not a number": (
        replaced("end = 2.0", "end = nan"),
        "time.end: nan is not a finite number; give a finite number",
    ),
    "infinity": (
        replaced("end = 2.0", "end = inf"),
        "time.end: inf is not a finite number; give a finite number",
    ),
    "a broken number of dimensions": (
        replaced("dimensions = 2", "dimensions = 2.0"),
        "space.dimensions: 2.0 is not a whole number; give a whole number",
    ),
    "a boolean number of dimensions": (
        replaced("dimensions = 2", "dimensions = true"),
        "space.dimensions: true is not a whole number; give a whole number",
    ),
    "a number for a choice": (
        WATER + "[walls.floor]\nno_slip = 3\nshape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }\n",
        "walls.floor.no_slip: 3 is not true or false; give true or false (the fluid has the wall's velocity at",
    ),
    "four dimensions": (
        replaced("dimensions = 2", "dimensions = 4"),
        "space.dimensions: 4 is out of range; it must be at least 1 and at most 3",
    ),
    "a cfl that is too large": (
        replaced("end = 2.0", "end = 2.0\ncfl = 0.7"),
        "time.cfl: 0.7 is out of range; it must be above 0 and at most 0.5",
    ),
    "h in place of h/dx": (
        replaced("smoothing = 1.3", "smoothing = 0.13"),
        "space.smoothing: 0.13 is out of range; it must be at least 0.6 and at most 4",
    ),
    "a parameter out of range, given bare": (
        replaced("[physics]", "[physics]\nfree_surface = 3.0"),
        "physics.free_surface: 3.0 is out of range; it must be above 0 and below 2",
    ),
    "a parameter out of range, in its table": (
        replaced("[physics]", "[physics]\nfree_surface.threshold = 3.0"),
        "physics.free_surface.threshold: 3.0 is out of range; it must be above 0 and below 2",
    ),
    "an effect switched on like a lamp": (
        replaced("[physics]", "[physics]\nfree_surface = true"),
        "physics.free_surface: true is not a number; give a number (β: below this kernel sum a "
        'particle is surface), or "off" to switch the effect off',
    ),
    "gravity as a number": (
        replaced("gravity = [0.0, -9.8]", "gravity = 9.8"),
        "physics.gravity: 9.8 is not a list; give a list such as [0.0, 0.0] (g, one number",
    ),
    "an unknown kernel": (
        replaced('kernel = "hyperbolic"', 'kernel = "cubik"'),
        "space.kernel: \"cubik\" is not known; did you mean 'cubic'?",
    ),
    "a number that is none of a choice": (
        replaced("end = 2.0", "end = 2.0\npasses = 0"),
        "time.passes: 0 is not known; known here: 1, 2, auto",
    ),
    "an unknown choice of effect": (
        replaced("[physics]", '[physics]\npressure_gradient = "antisymetric"'),
        "physics.pressure_gradient: \"antisymetric\" is not known; did you mean 'symmetric'?",
    ),
    "a wrong entry in a list": (
        replaced("lower = [0.0, 0.0]", "lower = [0.0, true]"),
        "fluids.water.shape.box.lower[1]: true is not a number; give a number (corner with",
    ),
    "an empty list": (
        replaced("lower = [0.0, 0.0]", "lower = []"),
        "fluids.water.shape.box.lower: [] is too short; list at least 1",
    ),
    "an axis that is no list": (
        replaced("spacing = 0.1", 'spacing = 0.1\nperiodic = "x"'),
        'space.periodic: "x" is not a list; give a list such as ["x"] (periodic axes)',
    ),
    "a name in place of a list of names": (
        WATER + '[gauges.push]\nforce.on = "tank"',
        'gauges.push.force.on: "tank" is not a list; give a list such as ["tank"] (names of walls',
    ),
    "one perturbation in place of a list": (
        WATER + "[perturbations]\nposition = [0.0, 0.0]",
        "perturbations: { ... } is not a list; give a list such as [{ ... }, { ... }] (kicks",
    ),
    "a number for a table": (
        "time = 2.0\n" + replaced("[time]\nend = 2.0", ""),
        "time: 2.0 is not a table; write [time] and its keys below it (simulated time",
    ),
    "a number for a title": (
        "title = 3\n" + WATER,
        "title: 3 is not a text in quotes; give a text in quotes (title of the case",
    ),
    "a name with a blank": (
        WATER + f"[fluids.'salt water']\n{BOX}",
        "fluids.salt water: a name is made of letters, digits, - and _; give another",
    ),
    "an unknown pressure": (
        WATER + 'pressure = "hydro"',
        'fluids.water.pressure: "hydro": not a pressure; give a number in Pa, "hydrostatic" or "exact"',
    ),
    "an infinite pressure": (
        WATER + "pressure = inf",
        'fluids.water.pressure: inf: not a pressure; give a number in Pa, "hydrostatic" or "exact"',
    ),
    "an unknown probe field": (
        WATER + PROBE + 'fields = ["presure"]',
        "probes.P1.fields[0]: \"presure\" is not known; did you mean 'pressure'?",
    ),
    "an unknown theory": (
        WATER + PROBE + "theory.presure = 1.0",
        "probes.P1.theory.presure: unknown key; did you mean 'pressure'?",
    ),
    "no field": (WATER + PROBE + "fields = []", "probes.P1.fields: [] is too short; list at least"),
    "a negative density": (
        WATER + "density = -1.0",
        "fluids.water.density: -1.0 is out of range; it must be above 0",
    ),
    "a broken seed": (
        WATER + "seed = 1.5",
        "fluids.water.seed: 1.5 is not a whole number; give a whole number (seed of",
    ),
    "frames that never end": (
        WATER + "[output]\nframes = 0.0",
        "output.frames: 0.0 is out of range; it must be above 0",
    ),
}


@pytest.mark.parametrize(("text", "says"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_one_line(tmp_path, text, says):
    [line] = refusal(tmp_path, text)
    assert line.startswith(f"case.toml: {says}")
    assert "\n" not in line


def test_a_missing_key_beside_a_foreign_one_is_a_second_line(tmp_path):
    lines = refusal(tmp_path, replaced("end = 2.0", "qqq = 2.0"))
    assert [line.split(": ")[1] for line in lines] == ["time.end", "time.qqq"]


def test_every_fault_is_found_at_once(tmp_path):
    text = replaced("spacing = 0.1", "spacing = -0.1").replace("end", "ende") + "viscocity = 1.0"
    lines = refusal(tmp_path, text)
    assert [line.split(": ")[1] for line in lines] == [
        "space.spacing",
        "time.ende",
        "fluids.water.viscocity",
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "true"),
        ("a", '"a"'),
        ([1, "b"], '[1, "b"]'),
        ({"a": 1}, "{ ... }"),
        ("x" * 50, '"' + "x" * 35 + " ..."),
    ],
)
def test_values_are_shown_as_in_toml(value, text):
    assert plain(value) == text
