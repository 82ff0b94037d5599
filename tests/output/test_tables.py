"""CSV tables: what is written stands in the file at once, with all its digits."""

import numpy as np
import pytest

from psph.output.errors import OutputError
from psph.output.tables import CsvTable


def test_row_is_on_disk_at_once_and_exact(tmp_path, alone):
    table = CsvTable(tmp_path / "log.csv", ["time", "step", "speed"], alone)
    table.write([0.1 + 0.2, 7, np.float64(1) / 3])
    text = "time,step,speed\n0.30000000000000004,7,0.3333333333333333\n"
    assert (tmp_path / "log.csv").read_text() == text
    table.close()
    table.close()


def test_missing_folder_is_one_line(tmp_path, alone):
    with pytest.raises(OutputError, match="none/log.csv: cannot be written: No such file"):
        CsvTable(tmp_path / "none" / "log.csv", ["time"], alone)


def test_full_disk_is_one_line(alone):
    with pytest.raises(OutputError, match="/dev/full: cannot be written: No space left on device"):
        CsvTable("/dev/full", ["time"], alone)
