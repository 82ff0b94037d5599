"""Walls that hold the fluid, and walls that it parts from: psph.physics.fluid.parting."""

from types import SimpleNamespace

import numpy as np
import pytest
from physics.pairs import pair_of, view

from psph.physics.fluid.correction import CorrectionBesideWalls
from psph.physics.fluid.parting import Holding, Parting, PartingBesideStrength, hold_of
from psph.physics.fluid.pressure import SymmetricPressure
from psph.vectors import times

FLUID, WALL = SimpleNamespace(is_fluid=True), SimpleNamespace(is_fluid=False)


def facts(floor, surface, species, laws=()):
    """What the form rests on."""
    return SimpleNamespace(
        physics=SimpleNamespace(tension_floor=floor),
        has_free_surface=surface,
        species=species,
        strengths=laws,
    )


@pytest.mark.parametrize(
    ("floor", "surface", "species", "laws", "kind"),
    [
        (object(), True, (FLUID, WALL), (), Parting),
        (object(), True, (FLUID, WALL), ("sand",), PartingBesideStrength),
        (object(), True, (FLUID,), (), Holding),
        (object(), False, (FLUID, WALL), (), Holding),  # a closed flow may be under tension
        (None, True, (FLUID, WALL), (), Holding),
    ],
)
def test_walls_let_go_where_there_is_a_free_surface(floor, surface, species, laws, kind):
    assert type(hold_of(facts(floor, surface, species, laws))) is kind


def written_out(i, j, pair, pressures):
    """−m_j (p_i L_i/ρ_i² + p_j L_j/ρ_j²) ∇W_ij."""
    total = np.zeros(len(pair.x_ij))
    for one, p in zip((i, j), pressures):
        bent = np.add(pair.x_ij, times(one.gradient_correction, pair.x_ij))
        total -= p * one.specific_volume**2 * bent * pair.m_dw_r
    return total


@pytest.mark.parametrize("hold", [Holding(), Parting(), PartingBesideStrength()])
@pytest.mark.parametrize("kinds", [(1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])
@pytest.mark.parametrize("strengths", [(0.0, 0.0), (1.0, 0.0)])
@pytest.mark.parametrize("signs", [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])
def test_the_pressure_of_a_pair(hold, kinds, strengths, signs):
    """Tension acts between fluids, on soil, and on nothing that is beside a wall."""
    p = view()._replace(is_fluid=np.array(kinds), strength=np.array(strengths))
    p = p._replace(pressure=np.abs(p.pressure) * np.array(signs))
    i, j, pair = pair_of(p, 0, 1)
    lets_go = {Holding: False, Parting: min(kinds) == 0.0}.get(
        type(hold), min(kinds) == 0.0 and max(strengths) == 0.0
    )
    felt = np.maximum(p.pressure, 0.0) if lets_go else p.pressure
    found = np.multiply(SymmetricPressure(hold).radial(i, j, pair), pair.x_ij)
    found = found + CorrectionBesideWalls(0.5, 1e-4, hold).push(i, j, pair)
    assert found == pytest.approx(written_out(i, j, pair, felt), rel=1e-12)
    j, i, back = pair_of(p, 1, 0)
    other = np.multiply(SymmetricPressure(hold).radial(j, i, back), back.x_ij)
    other = other + CorrectionBesideWalls(0.5, 1e-4, hold).push(j, i, back)
    assert p.mass[0] * found == pytest.approx(-p.mass[1] * other, rel=1e-12)
