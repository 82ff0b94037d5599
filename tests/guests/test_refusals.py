"""What is wrong with a used file, or with what a case asks of it, is said in one line."""

import os
import re
import shutil

import pytest
from guests.test_guests import GUESTS, HERE, case  # noqa: F401 (a fixture)

from psph.case import CaseError, load
from psph.case.extensions import OWN_TABLES
from psph.composition.trial import UnknownField, WrongShape
from psph.errors import LONGEST_LINE
from psph.output.tables import ERRORS, LOG, PROBES
from psph.runs.explain import explain
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.reading import WithoutImage

BRINGS = '''
from typing import NamedTuple

from psph.physics.catalogue import Catalogue, Entry


class Mine(NamedTuple):
    """Something."""

    every: float = 1.0

{formula}
CATALOGUE = Catalogue({entries})
'''


@pytest.fixture
def mine(case, tmp_path):  # noqa: F811
    """A function: entries of a catalogue, a formula, further lines → the path of a case."""

    def make(entries, formula="", more="", used=("mine.py",)):
        path = case(more=more)
        (tmp_path / "mine.py").write_text(BRINGS.format(entries=entries, formula=formula))
        names = ", ".join(f'"{name}"' for name in used)
        path.write_text(path.read_text().replace("use = []", f"use = [{names}]"))
        return path

    return make


def line_of(path):
    """The one line with which a case is refused."""
    with pytest.raises(CaseError) as refused:
        load(path)
    [line] = refused.value.lines
    assert str(path) in line
    return line


TWICE = {
    "physics.equation_of_state=linear": "states",
    "physics.gravity": "effects",
    "physics.gravity=weak": "effects",
    "physics.pressure_gradient": "effects",
    "physics.pressure_gradient=minimum": "effects",
    "physics.sound_speed": "effects",
    "space.kernel=cubic": "kernels",
}
"""Keys that psph itself has, and the room of a catalogue that would bring them once more."""


@pytest.mark.parametrize(("key", "room"), TWICE.items())
def test_a_name_that_psph_has_is_to_be_another(key, room, mine):
    says = line_of(mine(f'{room}=(Entry("{key}", Mine),)'))
    assert "mine.py brings" in says and says.endswith("and there is one; rename it")


@pytest.mark.parametrize("key", ["walls.*.motion.a", "regions.*.a", "tables.a", "physics.a"])
def test_a_name_that_another_file_or_the_same_brings_is_to_be_another(key, mine, tmp_path):
    room = {"walls": "motions", "physics": "effects"}.get(key.partition(".")[0], key.partition(".")[0])
    entry = f'Entry("{key}", Mine)'
    assert f"mine.py brings {key}, and there is one" in line_of(mine(f"{room}=({entry}, {entry})"))
    path = mine(f"{room}=({entry},)", used=("mine.py", "other.py"))
    text = (tmp_path / "mine.py").read_text()
    (tmp_path / "other.py").write_text(f"# another\n{text}")
    assert f"other.py brings {key}, and there is one" in line_of(path)
    load(mine(f"{room}=({entry},)", used=("mine.py", "./mine.py")))  # named twice, it is there once


def test_effects_may_share_a_key_that_is_no_table_of_theirs(mine):
    path = mine('effects=(Entry("fluids.*.viscosity", Mine),)')
    load(path)


@pytest.mark.parametrize("name", [*OWN_TABLES, "Log"])
def test_a_table_of_the_name_of_psph_s_own_is_refused(name, mine):
    says = line_of(mine(f'tables=(Entry("tables.{name}", Mine),)'))
    assert f"tables.{name}, and psph writes {name.lower()}.csv itself; rename it" in says
    assert {f"{own}.csv" for own in OWN_TABLES} == {LOG, PROBES, ERRORS}


SWINGING = GUESTS["swinging"]
STILL = 'Entry("walls.*.motion.still", Mine)'

ASKED = {
    "a fluid that is none": (
        "passing",
        'regions.sink.into = "wat"',
        "regions.sink.into: \"wat\": no fluid has this name; did you mean 'water'?",
    ),
    "a wall for a fluid": (
        "passing",
        'regions.source.into = "floor"',
        "no fluid has this name; known here: water",
    ),
    "a region that is none": ("passing", "regions.x = {}", "regions.x: does not say what happens there"),
    "a region of a fluid alone": ("passing", 'regions.x.into = "water"', "give one of: drain, spring"),
    "a motion that is none": (
        "swinging",
        None,
        "walls.floor.motion: does not say how it moves; give one of: translation, ",
    ),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_a_case_asks_wrongly_is_refused_in_one_line(name, case):  # noqa: F811
    guest, more, says = ASKED[name]
    path = case(guest, more=more or "")
    if more is None:
        path.write_text(path.read_text().replace(SWINGING, "walls.floor.motion = {}"))
    assert says in line_of(path)


def test_a_wall_moves_in_one_way(mine, tmp_path):
    shutil.copy(HERE / "swinging.py", tmp_path)
    more = f"{SWINGING}\nwalls.floor.motion.still = {{}}"
    says = line_of(mine(f"motions=({STILL},)", more=more, used=("swinging.py", "mine.py")))
    assert says.endswith(
        "walls.floor.motion: a part moves in one way, not in 2; give one of: translation, rotation, "
        "sinusoid, acceleration, series, piston, flap, irregular, solitary, swinging, still"
    )


@pytest.mark.parametrize(
    ("read", "says"),
    [
        ("i.colour", "Mine reads 'colour' of a particle; it may read position, "),
        ("pair.dw_rr", "Mine reads 'dw_rr' of a pair; it may read x_ij, "),
        ("i.kernel_sum", "Mine reads 'kernel_sum', which no effect of this scene writes; it may read "),
    ],
)
def test_a_formula_that_reads_what_nobody_has_is_refused_with_its_file(read, says, mine, tmp_path):
    formula = f"    def radial(self, i, j, pair):\n        return {read}\n"
    path = mine('effects=(Entry("physics.mine", Mine),)', formula, "physics.mine = {}")
    with pytest.raises(UnknownField) as refused:
        make_plan(Scene(load(path)))
    line = str(refused.value)
    assert line.startswith(f"{path}: use: {tmp_path / 'mine.py'}: {says}") and refused.value.exit_code == 2
    assert "\n" not in line and len(line) < LONGEST_LINE and ("viscosity" in line or "dw_r" in line)


MARKED = """    writes = Field("mark", "1", "how marked it is"{shape})

    def start(self, i):
        return 0.0

    def gather(self, total, i, j, pair):
        return total + j.mark{first} * pair.w

    def finish_value(self, total, i, kernel):
        return total
"""


@pytest.mark.parametrize("shape", ["", ", image=Turned", ", VECTOR, image=Same"])
def test_a_field_that_does_not_say_how_a_mirror_turns_it_is_refused_beside_one(shape, mine):
    """Declared by none of the rules, or by one of another shape; without a mirror it is taken."""
    formula = MARKED.format(shape=shape, first="[0]" * ("VECTOR" in shape))
    path = mine('effects=(Entry("physics.mine", Mine),)', formula, "physics.mine = {}")
    brought = path.with_name("mine.py")
    brought.write_text("from psph.fields import *\n" + brought.read_text())
    make_plan(Scene(load(path)))
    path.write_text(path.read_text().replace('periodic = ["x"]', 'symmetry = ["x.lower"]'))
    with pytest.raises(WithoutImage) as refused:
        make_plan(Scene(load(path)))
    says = (
        "Mine reads 'mark' of a neighbour, and a mirror cannot show it: let its Field say how an image has it"
    )
    assert str(refused.value).startswith(f"{path}: use: {brought}: {says}, as image=Same of a number, ")


def test_a_link_to_a_file_elsewhere_is_refused_and_not_executed(mine, tmp_path):
    path = mine("")
    mark, elsewhere = tmp_path / "mark", tmp_path.with_name(f"{tmp_path.name}-elsewhere")
    elsewhere.mkdir()
    (elsewhere / "mine.py").write_text(f"open({str(mark)!r}, 'w')\n{BRINGS.format(entries='', formula='')}")
    used = tmp_path / "mine.py"
    used.unlink()
    used.symlink_to(elsewhere / "mine.py")
    assert "is a link to a file outside the case's folder" in line_of(path) and not mark.exists()
    used.unlink()
    used.symlink_to(used)
    assert "give a file that is there" in line_of(path)
    used.unlink()
    os.mkfifo(used)
    assert "is not a regular file" in line_of(path)
    used.unlink()
    shutil.copy(elsewhere / "mine.py", tmp_path / "there.py")
    used.symlink_to("there.py")  # the control
    load(path)
    assert mark.exists()


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        ("    def radiall(self, i, j, pair):\n        return 0.0\n", "did you mean 'radial'?"),
        ("    def zap(self, i):\n        return 0.0\n", "known here: admit, bearing_density, body, "),
    ],
)
def test_a_method_that_nothing_calls_is_refused(formula, says, mine):
    line = line_of(mine('effects=(Entry("physics.mine", Mine),)', formula))
    assert "mine.py: Mine has a method " in line and "that psph never calls: " + says in line


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        (
            "radial(self, i, j, pair):\n        return pair.x_ij",
            "radial gives a tuple of 2 numbers; let it give a number",
        ),
        (
            "push(self, i, j, pair):\n        return pair.w",
            "push gives a number; let it give a tuple of 2 numbers",
        ),
        (
            "body(self, i):\n        return (0.0, 0.0, 1.0)",
            "body gives a tuple of 3 numbers; let it give a tuple of 2",
        ),
        (
            "density_rate(self, i, j, pair):\n        return (0.0,)",
            "density_rate gives a tuple of 1 numbers; let",
        ),
    ],
)
def test_a_formula_of_the_wrong_shape_is_refused(formula, says, mine):
    path = mine('effects=(Entry("physics.mine", Mine),)', f"    def {formula}\n")
    with pytest.raises(WrongShape, match="Mine." + re.escape(says)) as refused:
        make_plan(Scene(load(path, ["physics.mine={}"])))
    assert "mine.py: " in str(refused.value)


def test_an_effect_may_have_an_acceleration_of_its_own(mine):
    path = mine('effects=(Entry("physics.mine", Mine),)', "    acceleration = 3.0\n")
    assert [*explain(Scene(load(path, ["physics.mine={}"])), 1)]
