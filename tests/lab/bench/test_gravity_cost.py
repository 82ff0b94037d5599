"""The table of the tree: what it says of a small cloud."""

import pytest

from psph.lab.bench.gravity import CLOUDS, table_of_trees, tree_cost


@pytest.mark.parametrize("cloud", CLOUDS.values(), ids=lambda cloud: cloud.__name__)
def test_a_tree_sees_few_pairs_and_errs_little(cloud):
    """The more particles there are, the smaller is the part of all pairs that it sees."""
    small, large = (tree_cost(cloud, n, 1) for n in (3000, 12000))
    assert large.rms < 1.5e-3 and large.rms < large.most < large.largest < 2e-2
    assert 1e-7 < large.net < 3e-4
    assert large.seen < 0.5 * small.seen < 0.2


def test_the_table_has_a_row_for_each_cloud():
    lines = table_of_trees(500, 1).splitlines()
    assert len(lines) == 2 + len(CLOUDS) and all(line.count("|") == 8 for line in lines)
