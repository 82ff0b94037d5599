"""Runs of the shipped cases, and what the tests measure on them."""

import numpy as np
from mpi4py import MPI
from remedies import asked
from scipy.spatial import cKDTree

from psph.case import load
from psph.output.reader import Run
from psph.runs.start import run

CASES = "run/cases"


def finished(case, folder, *overrides):
    """The run of a case of ``CASES`` in this process: on one rank, since the bits are the same on any
    number of them (test_ranks.py), and ranks that share a core with other tests wait for each other."""
    path = asked(f"{CASES}/{case}.toml", folder, overrides)
    run(load(path, overrides), folder, MPI.COMM_SELF, say=lambda *_: None)
    return Run(folder)


def window(table, column, begin, end):
    """Values of a column of a table between two times, s."""
    inside = (table["time"] >= begin) & (table["time"] <= end)
    return table[column][inside]


def by_id(frame):
    """The arrays of a frame in the order of the ids."""
    order = np.argsort(frame["id"])
    return {name: values[order] for name, values in frame.items()}


def growth_rate(log, low=1e-6, high=1e-3):
    """Exponential growth of the largest speed while it lies between two speeds (m/s), 1/s."""
    speed = log["largest_speed"]
    first = np.argmax(speed > high)
    begin = first - np.argmax(speed[:first][::-1] < low)
    return np.polyfit(log["time"][begin:first], np.log(speed[begin:first]), 1)[0]


def checkerboard(frame, spacing, scale):
    """rms of p minus the mean over the eight nearest sites, over ``scale`` Pa, inside the fluid."""
    fluid = frame["kind"] == 0
    x, p = frame["position"], frame["pressure"]
    noise = []
    for i in np.flatnonzero(fluid):
        near = ((x - x[i]) ** 2).sum(axis=1) < (1.6 * spacing) ** 2
        near[i] = False
        if near.sum() >= 6:  # not at the surface
            noise.append(p[i] - p[near].mean())
    return np.sqrt(np.mean(np.square(noise))) / scale


def roughness(position, values, spacing):
    """rms over the particles of ``values`` (n, k) less the linear fit through the neighbours of each within 2.1
    spacings; particles with fewer than eight of them, at corners, are left out."""
    tree, rest = cKDTree(position), []
    for i, near in enumerate(tree.query_ball_point(position, 2.1 * spacing)):
        near = np.array([j for j in near if j != i])
        if len(near) >= 8:
            plane = np.c_[np.ones(len(near)), position[near] - position[i]]
            rest.append(values[i] - np.linalg.lstsq(plane, values[near], rcond=None)[0][0])
    return np.sqrt(np.mean(np.square(rest)))
