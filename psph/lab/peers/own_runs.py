"""psph's own runs in the comparison: by benchmark and row the case, and the keys that are changed in it."""

from collections.abc import Iterable, Mapping

Runs = dict[str, tuple[str, tuple[str, ...]]]
"""By the label of a row: a case, and the keys that are changed."""

BOX = (
    "time.end=2.0",
    "space.spacing=0.05",
    "space.lower=[-0.15, 0.5, -0.15]",
    "space.upper=[3.4, 1.15, 2.0]",
    "fluids.water.shape.box.upper=[3.25, 1.0, 0.55]",
    "walls.tank.shape.difference.from.box={lower = [-0.15, -0.15, -0.15], upper = [3.4, 1.15, 1.0]}",
    "walls.tank.shape.difference.minus=[{box = {lower = [0.0, 0.0, 0.0], upper = [3.25, 1.0, 1.0]}}]",
    "walls.box.shape.box={lower = [0.65, 0.3, 0.0], upper = [0.8, 0.7, 0.15]}",
    "probes.P1.position=[0.8, 0.5, 0.021]",
    "probes.P3.position=[0.8, 0.5, 0.101]",
)
"""Kleefsman's box laid on a lattice of 0.05 m: the water stands 1.2 m from the box, as PySPH's does there."""

SENSOR = ("gauges.S1.sensor.position=[0.8, 0.5, 0.021]",)
"""Beside it.  SSPH knows no force on a wall, and psph had no sensors before 27 November 2026."""

WHOLE = ("space.symmetry=[]", "space.origin=[0.0, 0.0, 0.0]", "space.lower=[-0.15, -0.15, -0.15]")
"""The box without its plane of symmetry."""

TANK = (
    "time.end=4.0",
    "output.frames=4.0",
    "physics.sound_speed=9.486833",
    "physics.gravity=[0.0, -1.0]",
    "fluids.water.shape.box.upper=[2.0, 0.9]",
    "walls.tank.shape.difference.from.box={lower = [-0.1, -0.1], upper = [2.1, 1.0]}",
    "walls.tank.shape.difference.minus=[{box = {lower = [0.0, 0.0], upper = [2.0, 1.0]}}]",
)
"""The tank of PySPH's hydrostatic_tank: 2 m long, 0.9 m deep, g = 1 m/s², c = 10 √(gH)."""

VORTICES = ("fluids.water.viscosity=0.01", "time.end=1.0", "output.frames=1.0")
"""Taylor–Green vortices at Re 100, as the hard case has them."""

LID = ("time.end=10.0", "output.frames=5.0")

DEFAULT, PLAIN, SSPH = "default scheme", "plain SPH", "SSPH"

SCHEMES: dict[str, tuple[str, ...]] = {
    DEFAULT: (),
    PLAIN: ("scheme=sph", "physics.artificial_viscosity=0.1"),
    SSPH: ("scheme=ssph", "physics.artificial_viscosity=0.1"),
}
"""By name.  Both schemes of the paper have the artificial viscosity that free surfaces are run with."""

AS_IT_IS: dict[str, tuple[str, ...]] = SCHEMES | {PLAIN: ("scheme=sph",), SSPH: ("scheme=ssph",)}
"""The same for closed flows, which have a viscosity of their own."""


def _ladder(case: str, keys: tuple[str, ...], sizes: Iterable[tuple[str, str]]) -> Runs:
    """The default scheme at several spacings, in m, each with its words."""
    return {
        f"psph, {DEFAULT}, {words}": (case, (*keys, f"space.spacing={spacing}")) for words, spacing in sizes
    }


def _schemes(case: str, keys: tuple[str, ...], of: Mapping[str, tuple[str, ...]], words: str) -> Runs:
    """The schemes of the paper at one spacing."""
    return {f"psph, {name}, {words}": (case, (*keys, *changes)) for name, changes in of.items() if changes}


SIDES = (("25²", "0.04"), ("50²", "0.02"), ("100²", "0.01"))

RUNS: dict[str, Runs] = {
    "taylor_green": {
        "psph, `taylor_green.toml`": (
            "taylor_green.toml",
            ("physics.sound_speed=10", "time.end=1.0", "output.frames=1.0"),
        ),
        **_ladder("hard/taylor_green.toml", VORTICES, SIDES),
        f"psph, {DEFAULT}, jittered, 50²": (
            "hard/taylor_green.toml",
            (*VORTICES, "fluids.water.jitter=0.1"),
        ),
        **_schemes("hard/taylor_green.toml", VORTICES, AS_IT_IS, "50²"),
    },
    "cavity": {
        **_ladder("hard/cavity.toml", LID, SIDES),
        **_schemes("hard/cavity.toml", LID, AS_IT_IS, "50²"),
    },
    "tank": {
        **_ladder("hard/tank.toml", TANK, (("dx 0.02", "0.02"), ("dx 0.01", "0.01"))),
        **_schemes("hard/tank.toml", (*TANK, "space.spacing=0.02"), SCHEMES, "dx 0.02"),
    },
    "box": {
        f"psph, {DEFAULT}, half": ("dam_break_on_box.toml", (*BOX, *SENSOR)),
        f"psph, {DEFAULT}, whole": ("dam_break_on_box.toml", (*BOX, *SENSOR, *WHOLE)),
        **_schemes("dam_break_on_box.toml", (*BOX, *SENSOR), {PLAIN: SCHEMES[PLAIN]}, "half"),
    },
}

EARLIER: dict[str, Runs] = {
    "taylor_green": {"50²": ("hard/taylor_green.toml", VORTICES)},
    "cavity": {"50²": ("hard/cavity.toml", LID)},
    "tank": {"dx 0.02": ("hard/tank.toml", (*TANK, "space.spacing=0.02"))},
    "box": {"half": ("dam_break_on_box.toml", BOX)},
}
"""What older sources run with the default scheme and the cases that they had; by what follows their name."""
