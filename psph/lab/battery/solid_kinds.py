"""Elastic solids in both descriptions, with and without what each adds, in the same trials."""

from pathlib import Path

from psph.case.updated import UPDATED
from psph.lab.battery import command
from psph.lab.battery.comparison import Comparison
from psph.lab.battery.trials import Bound, Trial

SHOWN = {
    "rings": ("pieces", "flight", "momentum", "steps", "operations", "bytes"),
    "strip": ("pieces", "drift", "near_least"),
    "plate": ("period_error", "swing_kept"),
    "spin": ("kinetic", "angular", "pieces"),
}
"""Trials and the measures shown of each, the main one first."""

REMEDIES = {
    "updated": (),
    "updated, no artificial stress": ("physics.artificial_stress=off",),
    "updated, a fifth of the viscosity": ("physics.artificial_viscosity={alpha=0.2, beta=0.4}",),
    "updated, corrected gradients": ("physics.gradient_correction=0.5",),
}
"""What is changed in the scheme ``solid``."""


def _ways(*solids: str, contact: bool = False) -> dict[str, tuple[str, ...]]:
    """The keys of each description, and of what is left out of it, by its name."""

    def each(key: str) -> tuple[str, ...]:
        return tuple(f"solids.{name}.{key}" for name in solids)

    updated = ("scheme=solid", *each(f"description={UPDATED}"))
    if contact:
        updated += ("physics.contact=off", *each("law=saint-venant-kirchhoff"))
    own = {name: (*updated, *keys) for name, keys in REMEDIES.items()}
    return {"total": (), "total, no control": each("hourglass=0.0"), **own}


def _judging(case: str, name: str, end: float, ways, holds, goals=(), sets=()) -> Trial:
    return Trial(
        name,
        f"../solids/{case}",
        SHOWN[name][0],
        1.0,
        end,
        end,
        sets,
        holds=holds,
        goals=goals,
        schemes=tuple(ways),
        changes=ways,
    )


TRIALS = (
    _judging(
        "rings",
        "rings",
        0.02,
        _ways("left", "right", contact=True),
        (Bound("pieces", 2, 2), Bound("momentum", most=1e-9)),
        (Bound("flight", least=0.5),),
        ("solids.left.velocity=[7.0, 0.0]", "solids.right.velocity=[-7.0, 0.0]"),
    ),
    _judging(
        "pulled_strip",
        "strip",
        0.3,
        _ways("strip"),
        (Bound("pieces", 1, 1),),
        (Bound("drift", -0.02, 0.02),),
    ),
    _judging(
        "oscillating_plate",
        "plate",
        0.45,
        _ways("plate"),
        (Bound("period_error", -0.12, 0.12), Bound("swing_kept", least=0.8)),
        (Bound("period_error", -0.02, 0.02),),
        ("space.spacing=0.00125",),
    ),
    _judging(
        "spinning_plate",
        "spin",
        0.5,
        _ways("plate"),
        (Bound("pieces", 1, 1), Bound("kinetic", 0.93, 1.02)),
        (Bound("angular", most=1e-12), Bound("kinetic", 0.985, 1.0)),
    ),
)

SOLIDS = Comparison("solids", "description", TRIALS, SHOWN)


def solids(comm, out: Path | None) -> None:
    """Run them into the folder ``out``; collective."""
    command.compare(comm, SOLIDS, out)
