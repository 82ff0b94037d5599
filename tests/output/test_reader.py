"""A run's folder read back: finished, running, or not one at all."""

import numpy as np
import pytest

from psph.output.errors import NotThere
from psph.output.frames import FrameFile
from psph.output.reader import Run


def one_frame(folder, alone, name="tank.h5"):
    FrameFile(folder / name, alone, {"case": "a = 1"}).write(
        0, 0.5, 1, {"position": np.zeros((3, 2)), "id": np.arange(3)}
    )
    return Run(folder)


def test_frames_count_from_both_ends(tmp_path, alone):
    run = one_frame(tmp_path, alone)
    assert run.frame(0)["id"].tolist() == run.frame(-1)["id"].tolist() == [0, 1, 2]
    with pytest.raises(NotThere, match="frame: 7 is not one of the 1 frames so far"):
        run.frame(7)


def test_run_sees_what_has_come_since(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    run = Run(tmp_path)
    assert len(run.times) == 0
    frames.write(0, 0.5, 1, {"position": np.zeros((3, 2))})
    assert run.times.tolist() == [0.5]


def test_tables_are_columns(tmp_path, alone):
    run = one_frame(tmp_path, alone)
    assert run.probes() == {}
    (tmp_path / "probes.csv").write_text("time,P1.pressure\n")
    assert run.probes()["P1.pressure"].shape == (0,)
    (tmp_path / "log.csv").write_text("time,step\n0.1,1\n0.2,nan\n0.3,3\n0.4,")
    assert run.log()["time"].tolist() == [0.1, 0.2, 0.3]  # the last row is on its way
    assert np.isnan(run.log()["step"][1])


def test_other_hdf5_files_beside_the_frames_do_not_matter(tmp_path, alone):
    (tmp_path / "checkpoint.h5").write_bytes(b"")
    assert one_frame(tmp_path, alone).path.name == "tank.h5"


def test_runs_of_earlier_versions_are_told_by_their_index(tmp_path, alone):
    FrameFile(tmp_path / "tank.h5", alone, {}).complete_index()
    (tmp_path / "tank.xdmf").unlink(missing_ok=True)
    (tmp_path / "tank.xmf").write_text("", encoding="utf-8")
    (tmp_path / "other.h5").write_bytes((tmp_path / "tank.h5").read_bytes())
    assert Run(tmp_path).path == tmp_path / "tank.h5"


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ({}, "one file of frames .*, here: none; give the folder"),
        ({"a.h5": b"", "b.h5": b""}, "here: a.h5, b.h5; give the folder"),
    ],
)
def test_folder_of_no_run_is_one_line(tmp_path, files, message):
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    with pytest.raises(NotThere, match=message):
        Run(tmp_path)


def test_file_that_is_no_hdf5_is_one_line(tmp_path):
    (tmp_path / "a.h5").write_bytes(b"nothing")
    with pytest.raises(NotThere, match="a.h5: cannot be read: .*; is it a file of psph"):
        Run(tmp_path).times  # noqa: B018
