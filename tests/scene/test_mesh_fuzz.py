"""Damaged geometry files: each is refused in plain lines, or a scene is made of it."""

import time

import numpy as np
import pytest
import trimesh
from drafts import POOL, draft
from fuzzing import Tally, spoilt, thorough
from hypothesis import given
from hypothesis import strategies as st
from long import LONG
from scene.solids import cube

from psph.case import CaseError
from psph.errors import UNPRINTABLE
from psph.scene import Scene, check
from psph.scene.meshes.report import described

ENDINGS = {"stl": ("stl", "stl_ascii"), "obj": ("obj",), "ply": ("ply",)}


def corpus(ending):
    """A cube and a ball in all forms of a format; those of PLY with text too."""
    bodies = cube(0.0, 400.0), trimesh.creation.icosphere(subdivisions=1, radius=250.0)
    found = []
    for body in bodies:
        for kind in ENDINGS[ending]:
            data = body.export(file_type=kind)
            found.append(data.encode() if isinstance(data, str) else data)
        if ending == "ply":
            found.append(trimesh.exchange.ply.export_ply(body, encoding="ascii"))
    return found


@st.composite
def damaged(draw, texts):
    """One with faults of text, or with some bytes changed for any, or cut off."""
    if draw(st.booleans()):
        return draw(spoilt(texts))
    data = bytearray(draw(st.sampled_from(texts)))
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(data) - 1))
        some = draw(st.binary(min_size=1, max_size=8))
        data[at : at + len(some)] = some
    return bytes(data[: draw(st.integers(0, len(data)))] if draw(st.booleans()) else data)


@pytest.mark.timeout(900)
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("examples", [120, pytest.param(3000, marks=LONG)])
@pytest.mark.parametrize("ending", ENDINGS)
def test_damaged_files(ending, examples, tmp_path, capsys):
    (tmp_path / "parts").mkdir()
    text, tally = POOL.replace("post.stl", f"post.{ending}"), Tally()

    @thorough(examples)
    @given(damaged(corpus(ending)), st.sampled_from(("", "shell = 0.2, ")))
    def trial(data, more):
        (tmp_path / f"parts/post.{ending}").write_bytes(data)
        begun = time.process_time()
        try:
            scene = Scene(draft(tmp_path, text.replace("scale", f"{more}scale")))
            check(scene)
            assert all("nan" not in line for line in described(scene))
            assert np.isfinite(scene.particles(0, scene.layout.planes, 0).position).all()
            tally["accepted"] += 1
        except CaseError as error:
            assert error.lines
            for line in error.lines:
                assert line.startswith(f"{tmp_path}/case.toml: ") and not UNPRINTABLE.search(line)
                assert len(line) < 1500 and "Traceback" not in line
            tally["refused"] += 1
        assert time.process_time() - begun < 10.0
        said = capsys.readouterr()
        assert not said.out and not said.err

    trial()
    tally.tell()
    assert tally.total() >= examples and min(tally["accepted"], tally["refused"]) > examples // 20
