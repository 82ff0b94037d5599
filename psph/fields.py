"""What a particle can carry: a field is declared where it is born, by the effect that fills it.

Arrays, records, messages, files and the views that formulas see follow from the declarations.
"""

from collections import namedtuple
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

SCALAR, VECTOR, SYMMETRIC, MATRIX, AXIAL = "scalar", "vector", "symmetric", "matrix", "axial"
SLOPES = "slopes"
"""Shapes of a field: a number, one number per axis, a symmetric matrix (its rows from the diagonal
on), a full matrix by rows, one number per axis of rotation (in 2D z, in 3D x, y, z); the derivatives of a
symmetric matrix along each axis, one after the other."""


def indices(dimensions: int) -> dict[str, list[tuple[int, ...]]]:
    """The axes of each component of the shapes whose indices turn as places do."""
    axes = range(dimensions)
    upper: list[tuple[int, ...]] = [(d, e) for d in axes for e in axes if d <= e]
    return {
        VECTOR: [(d,) for d in axes],
        SYMMETRIC: upper,
        MATRIX: [(d, e) for d in axes for e in axes],
        SLOPES: [(d, *pair) for d in axes for pair in upper],
    }


FLUID, WALL, SOLID, OTHER, BUFFER, GAS = 0, 1, 2, 3, 4, 5
"""Values of ``kind``: a fluid particle moves freely, a wall particle does not, a solid one is held by its
neighbours of the start, another one is moved by the work of a kind of matter (psph.kinds), that of a buffer
is fluid behind an open end, one of an ideal gas has a smoothing length of its own."""

KINDS = ("fluid", "wall", "solid", "other", "buffer", "ideal gas")
"""Their names, in this order."""


class Same(NamedTuple):
    """An image has it as the particle does: a number that knows no direction."""

    shapes = (SCALAR,)


class Turned(NamedTuple):
    """Each index turns as a place does: the gradient of a number, a matrix of places."""

    shapes = (VECTOR, SYMMETRIC, MATRIX, SLOPES)


class Place(NamedTuple):
    """x′ = x − 2[(x − x₀)·n]n: where the image stands, m."""

    shapes = (VECTOR,)


class Moving(NamedTuple):
    """v′ = v − 2(v·n)n, and 2v_w − v at a plane that sticks: how the image moves, m/s."""

    shapes = (VECTOR,)


class Drifting(NamedTuple):
    """The difference of two velocities, m/s, or a rate of one: as :class:`Moving` without 2v_w."""

    shapes = (VECTOR,)


class VelocityGradient(NamedTuple):
    """∂v_a/∂x_b turns as a velocity in a and as a place in b, 1/s: a matrix by rows."""

    shapes = (MATRIX,)


class StrainRate(NamedTuple):
    """The symmetric part of a velocity gradient, 1/s; at a plane that sticks the shear along it goes on."""

    shapes = (SYMMETRIC,)


class Stress(NamedTuple):
    """Each index turns as a place does; behind a plane that sticks a stress goes on as it is, for the plane
    bears its shear, Pa or what is in proportion to it."""

    shapes = (SYMMETRIC,)


class StressUnderWeight(NamedTuple):
    """As :class:`Stress`, Pa; behind a plane that sticks it grows with the pressure of a still column, both
    from the tip of a cone on: friction is that at the plane, not that half a spacing before it.  To a pass
    that reads no pressure it is a plain :class:`Stress`."""

    shapes = (SYMMETRIC,)


class StillPressure(NamedTuple):
    """p′ = p + ρ₀g·(x′ − x), Pa: a still column goes on behind the plane."""

    shapes = (SCALAR,)


class StillDensity(NamedTuple):
    """ρ′ = ρ + ρ₀g·(x′ − x)/c², kg/m³, of such a column."""

    shapes = (SCALAR,)


class StillVolume(NamedTuple):
    """1/ρ′ of such a column, m³/kg."""

    shapes = (SCALAR,)


class StillSlope(NamedTuple):
    """∇ρ turns as a place does, and gains what the weight of such a column adds to it, kg/m⁴."""

    shapes = (VECTOR,)


class Numbered(NamedTuple):
    """The number of what acts on its like in another way than on others: an image is another one, −n."""

    shapes = (SCALAR,)


class Continued(NamedTuple):
    """The same, of what goes on behind a plane along which it slides and which bears no weight of it."""

    shapes = (SCALAR,)


class Field(NamedTuple):
    """A quantity that each particle carries.

    ``saved``: stands in every frame.  ``evolves``: has a rate and is advanced in time as density is;
    formulas then see its predicted value.  ``start``: what stands in it before it is first filled, a number
    or a function of the lattice (psph.scene.lattice) and of positions (n, dim), m, that gives n numbers.
    ``image``: how it turns at a plane mirror along which matter slips, and at one that it sticks to: one of
    the types above, of its shape; without one it cannot be read of a neighbour beside mirrors.  ``asked``: it
    is the last that its effect writes, and stored only where another reads it.
    """

    name: str
    unit: str
    meaning: str
    shape: str = SCALAR
    saved: bool = False
    evolves: bool = False
    start: Any = 0.0
    image: Any = None
    asked: bool = False

    @property
    def composed(self) -> bool:
        """Whether it has several components, by the dimension."""
        return self.shape != SCALAR

    @property
    def mirrored(self) -> bool:
        """Whether a mirror can show it: its ``image`` is one of its shape."""
        return self.image is not None and self.shape in self.image.shapes

    @property
    def rate(self) -> str:
        """The name of the rate of a field that evolves."""
        return f"{self.name}_rate"

    def width(self, dimensions: int) -> int:
        """Numbers that it takes."""
        return {
            SCALAR: 1,
            VECTOR: dimensions,
            SYMMETRIC: dimensions * (dimensions + 1) // 2,
            MATRIX: dimensions**2,
            SLOPES: dimensions**2 * (dimensions + 1) // 2,
            AXIAL: dimensions * (dimensions - 1) // 2,
        }[self.shape]


POSITION = Field("position", "m", "place", VECTOR, saved=True, image=Place)
VELOCITY = Field("velocity", "m/s", "velocity", VECTOR, saved=True, image=Moving)
PREDICTED_VELOCITY = Field(
    "predicted_velocity", "m/s", "velocity at the end of the step, predicted", VECTOR, image=Moving
)
ACCELERATION = Field("acceleration", "m/s2", "acceleration of the last pass", VECTOR, image=Drifting)
LISTED_POSITION = Field(
    "listed_position", "m", "place when the neighbour list was built", VECTOR, image=Place
)
DENSITY = Field("density", "kg/m3", "density", saved=True, image=StillDensity)
DENSITY_RATE = Field("density_rate", "kg/(m3 s)", "rate of density of the last pass", image=Same)
DENSITY_RATE_1 = Field("density_rate_1", "kg/(m3 s)", "rate of density one step before", image=Same)
DENSITY_RATE_2 = Field("density_rate_2", "kg/(m3 s)", "rate of density two steps before", image=Same)
PRESSURE = Field(
    "pressure",
    "Pa",
    "pressure: by the equation of state, of an elastic solid by its stress",
    saved=True,
    image=StillPressure,
)
SPECIFIC_VOLUME = Field("specific_volume", "m3/kg", "1/density, as the forces read it", image=StillVolume)

REFERENCE = Field("reference", "m", "place in the undeformed solid", VECTOR)
"""Where particles were at the start, of what keeps its neighbours or is followed by a gauge."""

HELD_ACCELERATION = Field(
    "held_acceleration",
    "m/s2",
    "part of the acceleration, or of the load, that serves for several steps",
    VECTOR,
    image=Drifting,
)
HELD_DENSITY_RATE = Field(
    "held_density_rate", "kg/(m3 s)", "part of the rate of density that serves for several steps", image=Same
)

CROSSED = Field("crossed", "1", "periods by which a particle has been taken back into the domain", VECTOR)

OF_EVERY_SCENE = (
    POSITION,
    VELOCITY,
    PREDICTED_VELOCITY,
    ACCELERATION,
    LISTED_POSITION,
    DENSITY,
    DENSITY_RATE,
    DENSITY_RATE_1,
    DENSITY_RATE_2,
    PRESSURE,
    SPECIFIC_VOLUME,
)
"""Fields that the step itself fills.  In 1D and 2D a mass is per m² and per m of depth, and a density
per the same."""

IDENTITY = (
    Field("id", "1", "number of the particle, unique and constant", saved=True),
    Field(
        "kind",
        "1",
        "0 fluid, 1 wall, 2 elastic solid, 3 other, 4 buffer of an open end or follower of another level of "
        "sizes, 5 ideal gas",
        saved=True,
    ),
    Field("group", "1", "number of its fluid, solid or wall, in the order of the case", saved=True),
)
"""Whole numbers that stand beside the fields."""


def _fixed(name: str, unit: str, meaning: str, image: Any = Same) -> Field:
    """A number that no effect changes."""
    return Field(name, unit, meaning, image=image)


OF_MATERIAL = (
    _fixed("mass", "kg", "mass"),
    _fixed("rest_density", "kg/m3", "density at zero pressure"),
    _fixed("sound_speed", "m/s", "numerical speed of sound"),
    _fixed("viscosity", "m2/s", "kinematic viscosity"),
    _fixed("cell_count", "1", "particles that fill a cell of the lattice of the start"),
    _fixed("is_fluid", "1", "1 in a fluid, else 0"),
    _fixed("fluid", "1", "number of the fluid from 1 on, 0 in what is none"),
    _fixed("mobile", "1", "1 where forces move the particle, else 0"),
    _fixed("ends_fluid", "1", "1 in fluid behind an open end, else 0"),
    _fixed("no_slip", "1", "1 in a wall to which the fluid sticks, else 0"),
    _fixed("rubs", "1", "1 in a viscous fluid and in a wall that it rubs on, else 0"),
    _fixed("extrapolated", "1", "1 in a wall whose pressure is that of the fluid before it, else 0"),
    _fixed("repulsive", "1", "1 in a wall whose particles repel the fluid, else 0"),
    _fixed("rheology", "1", "number of the law of a fluid's viscosity, 0 where that is constant"),
    _fixed(
        "solid",
        "1",
        "number of a rigid body or an elastic solid from 2 on, 1 in a wall, 0 in a fluid",
        Numbered,
    ),
    _fixed("wetting", "1", "cosine of the angle at which surfaces of fluids meet a wall or body, else 0"),
    _fixed("wetting_range", "1", "half the difference of that of lines that recede and advance"),
    _fixed("penalty", "1", "1 in a wall that pushes back what comes too near, else 0"),
    _fixed("shear_modulus", "Pa", "shear modulus of what bears an evolved stress, else 0"),
    _fixed("wave_modulus", "Pa", "P-wave modulus by which a contact of solids and walls is stiff, else 0"),
    _fixed("cone_tip", "Pa", "mean tension at which an evolved stress has no strength left, else 0"),
    _fixed("wave_speed", "m/s", "speed of pressure waves in the matter itself; the numerical one in a fluid"),
    _fixed("stress_diffusion", "1", "strength of the spreading of an evolved stress"),
    _fixed("rest_coefficient", "1", "stress across over that along gravity, in level ground at rest"),
    _fixed("strength", "1", "number of the law that bounds an evolved stress, 0 where none does", Continued),
)
"""Fixed at the start by the material: one number where all materials of a scene agree, else an array."""

APART = _fixed(
    "apart", "1", "1 where ordinary passes over pairs do not see the particle (psph.kinds), else 0"
)

OF_SCENE = (
    Field("smoothing_length", "m", "smoothing length h", saved=True, image=Same),
    _fixed("largest_speed", "m/s", "largest speed of any fluid particle, a step old; for displacements"),
)
"""What all particles of a scene share; formulas read it like a field.  In a gas h is one of each particle."""


def by_name(*groups: Iterable[Field]) -> dict[str, Field]:
    """The fields of some groups by their names; ValueError where two differ and share a name."""
    found: dict[str, Field] = {}
    for field in (field for group in groups for field in group):
        if found.setdefault(field.name, field) != field:
            raise ValueError(f"two fields are named '{field.name}', and they differ")
    return found


SAVED = tuple(field for field in (*IDENTITY, *OF_EVERY_SCENE) if field.saved)
"""What stands in the frames of every scene."""


def filled(effect) -> tuple[Field, ...]:
    """The fields that the sum of an effect fills: its ``writes``, one or several."""
    written = getattr(effect, "writes", ())
    return (written,) if isinstance(written, Field) else written


def fixed(effect) -> tuple[Field, ...]:
    """The fields that an effect brings and that stay as they are at the start: its ``fixed``."""
    return getattr(effect, "fixed", ())


PREFIX = "View_of__"


@cache
def view_of(names: tuple[str, ...]) -> type:
    """The NamedTuple in which formulas see these quantities of a particle, or of all particles.

    An entry is an array where the quantity varies, a number where the whole scene shares one value,
    and None where it is not needed.  Vectors and matrices are tuples of components.
    """
    made = namedtuple(PREFIX + "__".join(names), names, defaults=(None,) * len(names))
    made.__module__ = __name__  # the compile cache finds it again by its name: see __getattr__
    return made


def companions(field: Field) -> tuple[Field, ...]:
    """The further fields that advance one that evolves: its prediction and its rates."""
    name, unit = field.name, f"{field.unit}/s"
    return (
        Field(f"predicted_{name}", field.unit, f"{field.meaning}, predicted", field.shape, image=field.image),
        *(
            Field(f"{field.rate}{of}", unit, f"rate of {name} {when}", field.shape, image=field.image)
            for of, when in (("", "of the last pass"), ("_1", "one step before"), ("_2", "two steps before"))
        ),
    )


def seen_at(view, largest_speed: float):
    """The view with the speed of the fastest particle, where a formula reads it."""
    read = OF_SCENE[-1].name
    return view._replace(**{read: largest_speed}) if read in view._fields else view


def with_length(view, h: float):
    """The view with another smoothing length, m, where a formula reads that."""
    return view._replace(smoothing_length=h) if "smoothing_length" in view._fields else view


def __getattr__(name: str):
    if name.startswith(PREFIX):
        return view_of(tuple(name[len(PREFIX) :].split("__")))
    raise AttributeError(f"module {__name__} has no {name}")
