"""Rigid bodies without the fluid of their case, for the tests of their contacts, joints and lines."""

import math

import numpy as np
from mpi4py import MPI

from psph.scene import Scene
from psph.simulation.floating import FloatingBodies
from psph.simulation.plan import make_plan
from psph.simulation.poses import Poses, corners_of

FLAT = """
[space]
dimensions = 2
spacing = {dx}
[time]
end = 10.0
[physics]
sound_speed = 100.0
gravity = [0.0, -9.81]
contact = {{ friction = {friction}, restitution = {restitution} }}
[fluids.drop]
shape.box = {{ lower = [-3.0, 3.0], upper = [-2.8, 3.2] }}
"""


class Dry:
    """The bodies of a case without their fluid, in steps of ``dt`` s."""

    def __init__(self, case, dt=2e-3):
        self.scene, self.dt, self.time = Scene(case), dt, 0.0
        plan = make_plan(self.scene)
        self.floating = FloatingBodies(self.scene, plan)
        corners = corners_of(self.scene, plan)
        self.poses = Poses(plan.materials.rigid, corners, None, self.scene.gravity, (self.floating,))
        self.floating.meet(self.poses.maps)
        self.bodies = self.floating.bodies
        self._load()

    def step(self):
        self.time += self.dt
        self.poses.advance(self.time, self.dt)
        self._load()
        self.bodies.kick(self.time, self.dt, self.floating.contacts, self.floating.joints)
        self.poses.turn_to(self.time)

    def _load(self):
        none = np.zeros((len(self.bodies.bodies), 6), np.int64)
        self.floating.load(none, MPI.COMM_SELF, self.time, self.dt)

    def to(self, time):
        while self.time < time - 0.5 * self.dt:
            self.step()
        return self.bodies


def turned(degrees, points, about=(0.0, 0.0)):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [[round(about[0] + c * x - s * y, 12), round(about[1] + s * x + c * y, 12)] for x, y in points]


SOLID = """
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
physics.sound_speed = 100.0
physics.gravity = [0.0, 0.0, -9.81]
physics.contact = { friction = 0.7, restitution = 0.0 }
[fluids.drop]
shape.box = { lower = [-3.0, 0.0, 3.0], upper = [-2.8, 0.2, 3.2] }
[walls.floor]
shape.box = { lower = [-1.0, -1.0, -0.3], upper = [2.0, 1.0, 0.0] }
[bodies.cube]
shape.box = { lower = [0.0, 0.0, 0.02], upper = [0.4, 0.4, 0.42] }
density = 2000.0
velocity = [2.0, 1.0, 0.0]
spin = [0.0, 0.0, 3.0]
"""


def parts(*ends, bottom=-0.3, height=0.0):
    """A floor of a box between each two of some ``ends``, m."""
    return "".join(
        f"[walls.floor{n}.shape.box]\nlower = [{low}, {bottom}]\nupper = [{up}, {height}]\n"
        for n, (low, up) in enumerate(zip(ends, ends[1:]))
    )
