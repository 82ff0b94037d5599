"""What is said of the geometry files of a scene: what cannot be simulated, what is odd, what they are."""

import math
from collections.abc import Iterator

import numpy as np

from psph.case.consistency import walk
from psph.case.findings import Location
from psph.case.shapes import Shape
from psph.scene.forms.form import Form
from psph.scene.forms.make import form_of
from psph.scene.meshes.drawn import Drawn
from psph.scene.scene import Scene
from psph.scene.shapes import bounds, shown

FAR_LARGER, LARGER = 300.0, 30.0
"""Times the rest of a scene: a mesh so large is refused, and asked about.  Millimetres taken for metres make
it a thousand times too large."""

MANY_SITES = 10**9
"""Of a lattice, whose visit takes seconds: above that a mesh that would be asked about is refused."""

MISFIT = 0.05
"""Part of a mesh's volume by which that of its sites may differ without a warning."""

ASTRAY = 3.0
"""Times the rest of a scene that a mesh lies off it: its file has another origin."""

COARSE = 0.1
"""Spacings: how far the corners of a file may be rounded without a warning."""


def size_faults(scene: Scene) -> Iterator[str]:
    """Meshes in another unit than that of the scene, before its sites are visited."""
    rest = _rest(scene)
    many = math.prod(scene.layout.lattice.counts) > MANY_SITES
    moved = tuple(f"{part.key}." for part in scene.layout.parts if part.moves_whole)
    for one in scene.layout.meshes:
        moves = _stands_in(one, moved)  # what is around it is no smaller
        most = LARGER if many or moves else FAR_LARGER
        times = max(one.surface.size) / rest if rest else 0.0
        if times > most:
            yield (
                f"{one.key}: {one.mesh.file} is {one.size} in size, {times:.3g} times the rest of the scene; "
                f"lengths are in m: was the file in mm? Then give scale = {one.mesh.scale / 1000:g}"
            )


def sizes_of(scene: Scene, *parts: int) -> str:
    """How large the geometry files of these parts are, to end a message with; or nothing."""
    tables = tuple(f"{scene.layout.parts[part].key}." for part in parts)
    found = {f"{one.mesh.file} is {one.size}": None for one in scene.layout.meshes if _stands_in(one, tables)}
    return f"; {' and '.join(found)}" if found else ""


def _stands_in(one: Drawn, tables: tuple[str, ...]) -> bool:
    return any(key.startswith(tables) for key in one.keys)


def site_faults(scene: Scene) -> Iterator[str]:
    """Meshes that hold no site."""
    for one, sites in zip(scene.layout.meshes, scene.census.mesh_sites):
        if not sites:
            yield (
                f"{one.key}: no lattice site lies in {one.mesh.file}, {one.size} in size from "
                f"{shown(one.surface.lower)}, at a spacing of {scene.spacing:g} m; check scale (metres per "
                "unit of the file) and move, or make space.spacing smaller"
            )


def remarks(scene: Scene) -> Iterator[str]:
    """What will run with these meshes, but probably not as intended."""
    for one, sites in zip(scene.layout.meshes, scene.census.mesh_sites):
        for says in (*_faces(one), *_sizes(scene, one), *_volumes(scene, one, sites)):
            yield f"{one.key}: {says}"


def described(scene: Scene) -> Iterator[str]:
    """What each mesh is, a line each."""
    for one, sites in zip(scene.layout.meshes, scene.census.mesh_sites):
        body, surface = one.surface.body, one.surface
        edges = f"{body.open_edges:,} open edges" if body.open_edges else "closed"
        also = f" (also {', '.join(one.keys[1:])})" if len(one.keys) > 1 else ""
        if one.mesh.shell:
            what = f"a shell {one.mesh.shell:g} m thick"
        else:
            what = f"{one.times * surface.volume:.4g} m3"
            what += f", {_excess(scene, one, sites):+.1%} on the lattice" if _is_within(scene, one) else ""
        yield (
            f"{one.key}: {one.mesh.file}: {one.size} from {shown(surface.lower)} to "
            f"{shown(surface.upper)}, {len(surface.sheet.faces):,} triangles, {edges}, {what}: {sites:,} "
            f"sites{also}"
        )


def _faces(one: Drawn) -> Iterator[str]:
    body = one.surface.body
    if body.open_edges and not one.mesh.shell:
        yield (
            f"{body.open_edges:,} open edges around {body.holes:,} hole{'s' * (body.holes != 1)}: psph "
            "closes each towards its middle; repair the surface if that is not its form, or give shell = a "
            "thickness in m"
        )
    if body.turned:
        yield (
            f"{body.turned:,} of {len(one.surface.sheet.faces):,} faces lie the other way than those beside "
            "them: psph turns them round; check the result, or repair the surface"
        )


def _sizes(scene: Scene, one: Drawn) -> Iterator[str]:
    rest, longest = _rest(scene), max(one.surface.size)
    if rest and (longest > LARGER * rest or FAR_LARGER * longest < rest):
        yield (
            f"{one.size} in size beside a scene of {rest:.4g} m; lengths are in m: scale = 0.001 is right "
            f"for a file in mm, 1 for one in m, and here it is {one.mesh.scale:g}"
        )
    if rest and (off := _off(scene, one)) > ASTRAY * rest:
        yield (
            f"it lies {off:.4g} m from the rest of the scene, from {shown(one.surface.lower)} on; the file "
            "has an origin of its own: give move, which comes after scale and rotate"
        )
    if one.surface.rounding > COARSE * scene.spacing:
        yield (
            f"its corners lie so far from the origin of the file that they are taken as equal within "
            f"{one.surface.rounding:.2g} m; move the body to the origin before its export"
        )


def _volumes(scene: Scene, one: Drawn, sites: int) -> Iterator[str]:
    excess = _excess(scene, one, sites)
    if not one.mesh.shell and _is_within(scene, one) and abs(excess) > MISFIT:
        own, filled = one.times * one.surface.volume, sites * scene.spacing**3
        yield (
            f"the surface encloses {own:.4g} m3, its sites {filled:.4g} ({excess:+.0%}): at "
            f"{scene.spacing:g} m thin parts are lost or grow, or its parts overlap; make space.spacing "
            "smaller"
        )


def _rest(scene: Scene) -> float:
    """The largest extent, m, of what :func:`_others` encloses; 0 without any."""
    lower, upper = _others(scene)
    return float((upper - lower).max(initial=0.0))


def _is_drawn(one: Form) -> bool:
    """Whether it stands in a file, or has no end."""
    return hasattr(getattr(one, "of", one), "mesh") or not np.isfinite(one.bounds).all()


def _off(scene: Scene, one: Drawn) -> float:
    """The gap along an axis, m, between a mesh and what :func:`_others` encloses."""
    (lower, upper), (low, high) = _others(scene), bounds(one.shape)
    return float(np.maximum(low - upper, lower - high).max(initial=0.0))


def _others(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Corners of a box around the domain, where it is given, and all shapes but meshes, m; or none."""
    space, boxes = scene.case.space, []
    if space.lower and space.upper:
        boxes.append((space.lower, space.upper))
    inner: Location = ("no key",)
    for loc, value in walk(scene.case):
        if isinstance(value, Shape) and loc[: len(inner)] != inner:
            inner = loc
            boxes += (one.bounds for one in form_of(value).pieces() if not _is_drawn(one))
    if not boxes:
        return np.empty(0), np.empty(0)
    lower, upper = (np.array(ends) for ends in zip(*boxes))
    return lower.min(axis=0), upper.max(axis=0)


def _is_within(scene: Scene, one: Drawn) -> bool:
    """Whether a mesh lies in the lattice, but for a spacing: not half behind a mirror, for one."""
    (low, high), slack = bounds(one.shape), scene.spacing
    return all(
        a >= b - slack and c <= d + slack
        for a, b, c, d in zip(low, scene.layout.lattice.lower, high, scene.layout.lattice.upper)
    )


def _excess(scene: Scene, one: Drawn, sites: int) -> float:
    """How much more than a mesh encloses its sites hold, over that."""
    volume = one.times * one.surface.volume
    return sites * scene.spacing**3 / volume - 1.0 if volume > 0.0 else math.inf
