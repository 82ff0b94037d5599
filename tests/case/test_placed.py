"""What the entries of a case answer: psph.case.placed."""

from drafts import TANK, draft

from psph.acts import BODIES, FLUIDS, SOLIDS
from psph.case.placed import names_of
from psph.physics.walls.conditions import DYNAMIC

BESIDE = (
    "space.lower=[-1.0, -1.0]",
    "space.upper=[2.0, 2.0]",
    "solids.plate={shape={box={lower=[0.2, 0.1], upper=[0.6, 0.4]}}, density=1e3, young=1e6, poisson=0.3}",
    "bodies.box={shape={box={lower=[0.2, 0.6], upper=[0.5, 0.9]}}, density=500.0}",
    "physics.contact={}",
)


def test_all_that_holds_particles_stands_in_the_order_of_its_numbers(tmp_path):
    case = draft(tmp_path, TANK, *BESIDE)
    assert [entry.loc for entry in case.entries] == [
        ("fluids", "water"),
        ("solids", "plate"),
        ("walls", "tank"),
        ("bodies", "box"),
    ]
    assert [entry.of.word for entry in case.entries] == [FLUIDS, SOLIDS, DYNAMIC, BODIES]
    assert [entry.name for entry in case.movers] == ["water", "plate"]
    assert [entry.name for entry in case.entries if entry.of.flows] == ["water"]
    assert [entry.name for entry in case.entries if entry.of.rigid] == ["tank", "box"]
    assert names_of(case.entries, SOLIDS, BODIES) == ["plate", "box"]
    assert all(entry.of.pushed(case) for entry in case.entries if not entry.of.flows)


def test_alone_a_solid_is_pushed_by_nothing(tmp_path):
    alone = draft(
        tmp_path,
        """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
[solids.plate]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
density = 1000.0
young = 1e6
poisson = 0.3
""",
    )
    [plate] = alone.entries
    assert plate.of.moves_freely and not plate.of.flows and not plate.of.pushed(alone)
