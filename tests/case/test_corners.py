"""The table of what acts on what: what is refused is refused, and what acts is seen to."""

import json
import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from drafts import refusal
from jobs import clean_environment
from long import LONG

from psph.acts import (
    BODIES,
    DIMENSIONS,
    FLUIDS,
    FRAME,
    IDEAL_GASES,
    MATTER,
    MIXED,
    SEAM,
    SOILS,
    SOLIDS,
    SYMMETRY,
    THREE,
    TWO,
    UPDATED,
    refusals,
    refusals_of_effect,
)
from psph.case import CaseError, acts, load
from psph.case.acts import gauge_kinds, page
from psph.case.corners import (
    ACTS,
    IRRELEVANT,
    REFUSED,
    answer,
    between,
    rows_of_effects,
    rows_of_gauges,
    speaking,
)
from psph.physics.catalogue import BUILT_IN, Catalogue, Entry
from psph.physics.fluid.gravity import Gravity
from psph.physics.walls.conditions import CONDITIONS, CORNERS

NAMES = dict(zip(MATTER, ("water", "sand", "block", "plate", "air", "brick")))
"""What is made of each kind of matter in the scenes below."""

HOOKE = "density = 1500.0, young = 1e6, poisson = 0.3"
MOVES = "velocity_gradient = [[30.0, 40.0], [10.0, -50.0]], jitter = 0.2, seed = 3"
"""Fast enough for what acts on impacts alone."""
MADE_OF = {
    FLUIDS: "fluids.water = { shape.box = { lower = LOW, upper = HIGH }, MOVES }",
    SOILS: f"soils.sand = {{ shape.box = {{ lower = LOW, upper = HIGH }}, {HOOKE}, friction_angle = 30.0, cohesion = 1e6, MOVES }}",
    UPDATED: f"solids.block = {{ shape.box = {{ lower = LOW, upper = HIGH }}, {HOOKE}, "
    'description = "updated", MOVES }',
    SOLIDS: f"solids.plate = {{ shape.box = {{ lower = LOW, upper = HIGH }}, {HOOKE}, MOVES }}",
    IDEAL_GASES: "ideal_gases.air = { shape.box = { lower = LOW, upper = HIGH }, density = 1.0, "
    "pressure = 1e3, MOVES }",
    BODIES: "bodies.brick = { shape.box = { lower = LOW, upper = HIGH }, density = 800.0 }",
}


def boxes(text: str, number: int, dimensions: int) -> str:
    """The text with the corners of a box of its own, apart from those of other numbers."""
    low = [1.2 * number, *[0.0] * (dimensions - 1)]
    high = [1.2 * number + 0.6, *[0.6] * (dimensions - 1)]
    return text.replace("LOW", str(low)).replace("HIGH", str(high))


def scene(*corners: str, more: str = "", moves: str = MOVES) -> str:
    """A case that has some corners; water where nothing else is asked for."""
    dimensions = next((1 + DIMENSIONS.index(one) for one in corners if one in DIMENSIONS), 2)
    matter = [one for one in MATTER if one in corners] or [FLUIDS]
    if matter == [BODIES]:
        matter.append(FLUIDS)
    lines = ["time.end = 1.0", "physics.sound_speed = 30.0"] if {FLUIDS} & set(matter) else ["time.end = 1.0"]
    space = [f"dimensions = {dimensions}", "spacing = 0.1"]
    lower, upper = [-1.0] * dimensions, [8.0, *[1.0] * (dimensions - 1)]
    space += [f"lower = {lower}", f"upper = {upper}"]
    space += ['periodic = ["x"]'] * (SEAM in corners) + ['symmetry = ["x.lower"]'] * (SYMMETRY in corners)
    lines.append(f"space = {{ {', '.join(space)} }}")
    if "scheme" not in more:
        own = {UPDATED: "solid", IDEAL_GASES: "gas"}
        lines.append(f'scheme = "{own.get(matter[0], "sph") if len(matter) == 1 else "sph"}"')
    lines += ['precision = "mixed"'] * (MIXED in corners)
    lines += [f"frame.motion.translation = {[0.5] * dimensions}"] * (FRAME in corners)
    for number, one in enumerate(matter):
        lines.append(
            boxes(MADE_OF[one].replace(", MOVES", f", {moves}" if moves else ""), number, dimensions)
        )
    for condition in set(corners) & set(CONDITIONS):
        low, high = [-1.0] * dimensions, [8.0] * dimensions
        low[-1], high[-1] = -1.0, 0.0
        shape = f"{{ lower = {low}, upper = {high} }}"
        lines.append(f'walls.floor = {{ shape.box = {shape}, condition = "{condition}" }}')
    return "\n".join([*lines, more]) + "\n"


def value_of(effect, dimensions: int = 2) -> str:
    """Values for the parameters of an effect that have no default."""
    own = {"center": [0.1] * dimensions, "acceleration": [0.3] * dimensions, "begin": -1.0, "end": 8.0}
    own |= {"threshold": 0.9, "frequency": 2.0}
    needed = {name: own.get(name, 0.1) for name in effect._fields if name not in effect._field_defaults}
    return f"{{ {', '.join(f'{name} = {value}' for name, value in needed.items())} }}"


ASKED = {entry.effect.__name__: entry for entry in BUILT_IN.effects if entry.key.startswith("physics.")}
"""The effects that a key of ``physics`` asks for."""


def key_of(name: str, dimensions: int = 2) -> str:
    """What a case says to have an effect."""
    key, _, choice = ASKED[name].key.partition("=")
    return f'{key} = "{choice}"' if choice else f"{key} = {value_of(ASKED[name].effect, dimensions)}"


def test_the_page_has_every_effect_and_gauge_and_numbers_what_is_refused(capsys):
    runpy.run_path(acts.__file__, run_name="__main__")
    text = page()
    assert capsys.readouterr().out == f"{acts.HEAD}\n{text}"
    assert all(f"| {name} |" in text for name in ASKED) and "| gauges.*.force |" in text.replace("`", "")
    listed = re.findall(r"^(\d+)\. .+$", text, re.MULTILINE)
    assert listed == [str(k + 1) for k in range(len(listed))] and f"| {listed[-1]} |" in text


def test_every_sentence_is_a_line_that_says_what_to_do():
    askers = [*speaking().values(), *gauge_kinds().values(), *(entry.effect for entry in BUILT_IN.effects)]
    for asker in askers:
        for corner, says in refusals(asker).items():
            assert corner in CORNERS and "\n" not in says
            assert ";" in says or "need" in says, says
        assert set(getattr(asker, "acts", ())) <= set(CORNERS)


@pytest.mark.parametrize(
    ("name", "corner", "kind"),
    [
        ("Gravity", BODIES, ACTS),
        ("CentralForce", SOLIDS, ACTS),
        ("CentralForce", SEAM, REFUSED),
        ("DampingZone", SOLIDS, IRRELEVANT),
        ("DampingZone", UPDATED, REFUSED),
        ("Anvils", SYMMETRY, REFUSED),
        ("Strength", FLUIDS, IRRELEVANT),
        ("Strength", MIXED, REFUSED),
        ("ExtrapolatedWall", "dynamic", IRRELEVANT),
        ("MovingFrame", SOILS, REFUSED),
        ("MovingFrame", "mirror", REFUSED),
        ("MinimumPressure", BODIES, REFUSED),
        ("gauges.force", "repulsive", REFUSED),
        ("gauges.motion", BODIES, ACTS),
        ("gauges.motion", FLUIDS, IRRELEVANT),
        ("gauges.reaction", UPDATED, REFUSED),
        ("gauges.reaction", BODIES, IRRELEVANT),
        ("gauges.stress", SOILS, ACTS),
        ("gauges.stress", FLUIDS, IRRELEVANT),
    ],
)
def test_the_table_has_what_each_says_and_what_follows(name, corner, kind):
    kinds = {f"gauges.{key}": table for key, table in gauge_kinds().items()}
    rows = {row.name: row for row in (*rows_of_effects(BUILT_IN), *rows_of_gauges(kinds))}
    assert rows[name].answers[CORNERS.index(corner)].kind == kind


@pytest.mark.parametrize("name", ASKED)
def test_what_an_effect_refuses_is_refused(name, tmp_path):
    for corner, says in refusals_of_effect(ASKED[name].effect).items():
        corners = (FLUIDS, corner) if corner in (SOLIDS, BODIES, *CONDITIONS) else (corner,)
        lines = refusal(tmp_path, scene(*corners, more=key_of(name)))
        assert any(says in line and "physics." in line for line in lines), (corner, lines)


@pytest.mark.parametrize(
    ("one", "corner"), [(one, corner) for one in speaking() for corner in CORNERS if between(one, corner)]
)
def test_kinds_that_do_not_go_together_are_refused(one, corner, tmp_path):
    lines = refusal(tmp_path, scene(one, corner))
    assert any(between(one, corner) in line for line in lines), lines


def test_a_gauge_refuses_what_it_cannot_measure(tmp_path):
    force = gauge_kinds()["force"]
    for condition, says in refusals(force).items():
        [line] = refusal(tmp_path, scene(condition, more='gauges.push.force.on = ["floor"]'))
        assert says in line
    text = scene(UPDATED, more='gauges.held.reaction.of = ["solids.block.clamped"]')
    clamped = "solids.block.clamped={box={lower=[0.0,0.0],upper=[0.2,0.2]}}"
    [line] = refusal(tmp_path, text, clamped)
    assert refusals(gauge_kinds()["reaction"])[UPDATED] in line
    [line] = refusal(tmp_path, scene(SOLIDS, more='gauges.top.highest.axis = "y"'))
    assert "measures fluids, soils and updated Lagrangian solids alone, and the case has none" in line


@pytest.mark.parametrize(
    ("beside", "key", "cure"),
    [
        (BODIES, "damping", "rigid bodies meet by impulses"),
        (BODIES, "stiffness", "rigid bodies do not give way"),
        (SOLIDS, "restitution", "elastic solids swing back by themselves"),
    ],
)
def test_a_key_of_other_matter_is_refused(beside, key, cure, tmp_path):
    [line] = refusal(tmp_path, scene(beside, more=f"physics.contact = {{ friction = 0.2, {key} = 0.5 }}"))
    assert f"physics.contact.{key}" in line and cure in line


class Sideways(Gravity):
    """An effect of one's own that says a word that is none."""

    acts = ("fluid",)


def test_a_word_that_says_nothing_is_refused(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(scene(FLUIDS))
    with pytest.raises(CaseError, match="Sideways.acts: 'fluid' is no word of docs/acts.md; did you mean"):
        load(path, given=Catalogue(effects=(Entry("physics.sideways", Sideways),)))


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """A function: the text of a case → a digest of each of its groups after some steps, in plain Python."""
    folder = tmp_path_factory.mktemp("walk")
    process = subprocess.Popen(
        [sys.executable, Path(__file__).parents[1] / "walking.py"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=clean_environment() | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    known = {}

    def digests(text):
        if text not in known:
            path = folder / "case.toml"
            path.write_text(text)
            process.stdin.write(json.dumps({"path": str(path), "sets": []}) + "\n")
            process.stdin.flush()
            known[text] = json.loads(process.stdout.readline())
            assert "trouble" not in known[text], known[text]["trouble"]
        return known[text]

    yield digests
    process.stdin.close()
    process.wait(10)


PULLS = [name for name in ("Gravity", "CentralForce", "DampingZone", "OtherDampingZone") if name in ASKED]


@pytest.mark.parametrize("beside", [SOILS, SOLIDS, BODIES])
@pytest.mark.parametrize("name", PULLS)
def test_a_body_force_pulls_what_the_table_says_and_no_more(name, beside, walk):
    """Of water and other matter far from it: each is where it would be without, or it is not."""
    with_it, without = (walk(scene(FLUIDS, beside, more=more)) for more in (key_of(name), ""))
    for kind in (FLUIDS, beside):
        effect = ASKED[name].effect
        acts = answer(effect, kind, refusals_of_effect(effect)).kind == ACTS
        assert (with_it[NAMES[kind]] != without[NAMES[kind]]) == acts, kind


ELSEWHERE = (
    "SymmetricPressure",
    "CentralFriction",
    "LaplacianFriction",
    "WholeAttraction",
    "SofteningChange",
)
"""The default, without which there is another in its place; what acts in viscous fluids alone; and parts of
self-gravity, which comes with one key: tests/physics and tests/matter have them."""

CORRECTED = "physics.gradient_correction = 0.7"

NEEDS = {
    "ReconstructedDamping": (CORRECTED, ""),
    "FourthOrderDiffusion": (CORRECTED, ""),
    "LocalPotential": (CORRECTED, ""),
    "ArtificialStress": ("physics.artificial_stress = OFF", "physics.artificial_stress = 0.3"),
    "ShockViscosity": ("physics.shock_viscosity = OFF", ""),
    "HeatConduction": ("physics.heat_conduction = OFF", ""),
    "SolidContact": (boxes(MADE_OF[SOLIDS].replace("plate", "other").replace(", MOVES", ""), 0.5, 2), ""),
}
"""What a case has besides, without and with the effect in the place of its own key; where nothing, its key."""

APART = {
    "TensionFloor": {
        1: [[120.0]],
        2: [[150.0, 0.0], [0.0, 120.0]],
        3: [[50.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0] * 3],
    }
}
"""How it moves where another motion shows an effect: a soil opens by a tenth within the steps of a walk."""

CELLS = [
    (row.name, corner)
    for row in rows_of_effects(BUILT_IN)
    if row.name in ASKED and row.name not in ELSEWHERE
    for corner, one in zip(CORNERS, row.answers)
    if one.kind == ACTS
    and corner in MATTER
    and (row.name, corner) != ("SolidContact", BODIES)  # impacts: tests/simulation/test_touching.py
]


def around():
    """Effects on fluids, each in one of the surroundings in which the table says that it acts; all of these come
    in turn."""
    turn = 0
    for row in rows_of_effects(BUILT_IN):
        acting = [corner for corner, one in zip(CORNERS, row.answers) if one.kind == ACTS]
        if row.name in ASKED and row.name not in ELSEWHERE and FLUIDS in acting:
            there = [corner for corner in acting if corner not in (*MATTER, TWO)]
            yield row.name, there[turn % len(there)]
            turn += 1


def seen(walk, name, *corners):
    """Whether particles of the matter that comes first in ``corners`` are elsewhere with an effect than
    without."""
    without, instead = NEEDS.get(name, ("", ""))
    if TWO in refusals_of_effect(ASKED[name].effect):
        corners = (*corners, THREE)
    dimensions = next((1 + DIMENSIONS.index(one) for one in corners if one in DIMENSIONS), 2)
    off = without.endswith("OFF")
    with_it = instead or f"{'' if off else without}\n{key_of(name, dimensions)}"
    flow = {
        1: [[-50.0]],
        2: [[30.0, 40.0], [10.0, -50.0]],
        3: [[30.0, 40.0, 0.0], [10.0, -50.0, 0.0], [0.0] * 3],
    }
    moves = f"velocity_gradient = {APART.get(name, flow)[dimensions]}, jitter = 0.2, seed = 3"
    found = [
        walk(scene(*corners, more=more.replace("OFF", '"off"'), moves=moves))[NAMES[corners[0]]]
        for more in (without, with_it)
    ]
    return found[0] != found[1]


@LONG
@pytest.mark.parametrize(("name", "corner"), CELLS)
def test_what_acts_is_seen(name, corner, walk):
    assert seen(walk, name, corner)


@LONG
@pytest.mark.parametrize(("name", "corner"), list(around()))
def test_what_acts_in_surroundings_is_seen_there(name, corner, walk):
    assert seen(walk, name, FLUIDS, corner)
