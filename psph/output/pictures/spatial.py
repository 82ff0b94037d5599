"""A scene in 3D as people see it: lit particles or the surface of the fluid, walls half transparent, bodies
opaque."""

import ctypes
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from psph.errors import Refused
from psph.fields import WALL
from psph.output.pictures import style
from psph.output.pictures.camera import ANGLE, Camera, before, directions
from psph.output.pictures.carried import Carried, carried_parts
from psph.output.pictures.ruler import rulers
from psph.output.pictures.scale import Scale
from psph.output.pictures.view import Room
from psph.output.pictures.water import fluid_surface

FINER = 2
"""Pixels rendered for each one of the page, along each side: smooth edges."""
AROUND, WITHIN, EDGE = 0.3, 0.75, 0.7
"""Opacities of walls around the fluid, of others, and of the lines where their faces meet."""
CREASE = 30.0
"""Degrees between two faces from which on their edge is a line."""
ABSENT = (
    "plot: a scene in 3D needs pyvista, which is not installed: `pip install pyvista`; or look at a slice, "
    "such as --slice y=0.5"
)
NO_OPENGL = (
    "plot: a scene in 3D needs OpenGL, and VTK finds none: install Mesa's EGL (on Debian libegl1 and "
    "libgl1-mesa-dri); or look at a slice, such as --slice y=0.5"
)


def pyvista():
    """The module, made quiet.  Refused, in one line, where it is missing."""
    try:
        import pyvista
    except ModuleNotFoundError as error:
        if error.name == "pyvista":
            raise Refused(ABSENT) from None
        raise
    from vtkmodules.vtkCommonCore import vtkLogger

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    return pyvista


def scene(
    case: dict, folder: Path, start: dict, room: Room, boxes: Sequence[dict[int, np.ndarray]], smooth: bool
) -> "View3D":
    """The scene of ``case``, whose first frame is ``start``; its files are in ``folder``.

    ``boxes`` (2, 3), m, are those around each group in time.

    What stands still is seen whole, but for the thickness of walls around the fluid.
    """
    parts = list(carried_parts(case, start, room.spacing, folder))
    still = [part for part in parts if _stands([one[part.group] for one in boxes if part.group in one])]
    seen = {part.group for part in still}
    visible = [part.faces.reshape(-1, 3) for part in still]
    visible += [box for one in boxes for group, box in one.items() if group not in seen]
    return View3D(room, parts, np.concatenate(visible), smooth)


def _stands(boxes: Sequence[np.ndarray]) -> bool:
    """Whether the box (2, 3) around a wall, which may have no particles, is always the same."""
    return all(np.array_equal(boxes[0], box) for box in boxes)


class View3D:
    """All of a ``room`` with its rigid ``parts``, seen by one camera from the left, the front and above.

    It shows the box around all of the ``visible`` points, (n, 3) m.  ``smooth``: the fluid has a surface in
    place of particles.  Raises Refused where 3D cannot be drawn.
    """

    keyed = True

    def __init__(
        self,
        room: Room,
        parts: Iterable[Carried],
        visible: np.ndarray,
        smooth: bool,
    ):
        self.room, self.parts, self.smooth = room, list(parts), smooth
        self.variant = self.remark = "surface" if smooth else ""
        self._axes = directions(room.up, room.sense, room.level[0])
        self.see(visible)
        self._pv = pyvista()

    def see(self, visible: np.ndarray) -> None:
        """Look at the box around all of some points (n, 3), m, in the room."""
        self.lower = np.maximum(self.room.lower, visible.min(axis=0))
        self.upper = np.minimum(self.room.upper, visible.max(axis=0))
        self.aspect = self.camera(None).aspect

    def camera(self, aspect: float | None) -> Camera:
        """That of a picture with this width over its height; None: as the box asks for."""
        return before(self.lower, self.upper, self._axes, aspect)

    def of(self, frame: dict) -> dict:
        """All of ``frame``."""
        return frame

    def draw(self, axes: Axes, frame: dict, scale: Scale, first: bool, last: bool) -> None:
        """One frame; the panel that is both ``first`` and ``last`` has rulers."""
        pixels = axes.figure.get_size_inches() * axes.get_position().size * axes.figure.dpi
        camera = self.camera(pixels[0] / pixels[1])
        image = self.image(frame, scale, camera, np.round(FINER * pixels).astype(int).tolist())
        axes.imshow(image, extent=(0, 1, 0, 1), aspect="auto", interpolation="antialiased")
        axes.set_axis_off()
        axes.set(xlim=(0, 1), ylim=(0, 1))
        if first and last:
            rulers(axes, camera, self.lower, self.upper, self.room)

    def image(self, frame: dict, scale: Scale, camera: Camera, size: list[int]) -> np.ndarray:
        """The pixels (height, width, 3) of a frame in a picture of ``size``, width and height."""
        plotter = self._pv.Plotter(off_screen=True, window_size=size, lighting="none")
        try:
            _refuse_without_opengl(plotter.render_window)
            plotter.set_background("white")
            fluid = (frame["kind"] != WALL) & self.room.holds(frame["position"])
            shown = (frame[name][fluid] for name in ("position", "values", "width"))
            self._add_fluid(plotter, *shown, scale)
            for part in self.parts:
                self._add_part(plotter, part, part.at(frame))
            for points, tension in frame["lines"].values():
                plotter.add_lines(points, color=style.of_line(tension), width=2 * FINER, connected=True)
            self._light(plotter, camera)
            plotter.enable_ssao(radius=2 * self.room.spacing, bias=0.1 * self.room.spacing, kernel_size=32)
            plotter.camera.position = camera.eye
            plotter.camera.focal_point = camera.eye + camera.ahead
            plotter.camera.up = camera.up
            plotter.camera.view_angle = ANGLE
            plotter.reset_camera_clipping_range()
            return plotter.screenshot(return_img=True)
        finally:
            plotter.close()

    def _add_fluid(
        self, plotter, places: np.ndarray, values: np.ndarray, width: np.ndarray, scale: Scale
    ) -> None:
        if not len(places):
            return
        shine = {"ambient": 0.5, "diffuse": 0.75, "specular": 0.15, "specular_power": 15.0}
        if self.smooth:
            water = fluid_surface(places, self.room.spacing, values, width)
            if water is not None:
                water["rgb"] = scale.rgb(water["values"])
                shine |= {"specular": 0.5, "specular_power": 40.0}
                plotter.add_mesh(water, scalars="rgb", rgb=True, smooth_shading=True, **shine)
            return
        from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

        cloud = self._pv.PolyData(places)
        cloud["rgb"], cloud["radius"] = scale.rgb(values), (width / 2).astype(np.float32)
        cloud.set_active_scalars("rgb")
        mapper = vtkOpenGLSphereMapper()
        mapper.SetInputData(cloud)
        mapper.SetScaleArray("radius")
        actor = self._pv.Actor()
        actor.SetMapper(mapper)
        for name, share in shine.items():
            setattr(actor.prop, name, share)
        plotter.add_actor(actor)

    def _add_part(self, plotter, part: Carried, faces: np.ndarray) -> None:
        if not len(faces):
            return
        seen = {"color": style.WALLS, "opacity": AROUND if part.around else WITHIN, "culling": "back"}
        if part.whole:  # one that a mirror or the domain's end cuts is seen from inside too
            seen = {"color": style.WHOLE, "culling": "back" if part.around else None}
        corners = faces.reshape(-1, 3)
        hull = self._pv.PolyData.from_regular_faces(corners, np.arange(len(corners)).reshape(-1, 3)).clean()
        plotter.add_mesh(hull, ambient=0.4, diffuse=0.7, **seen)
        edges = hull.extract_feature_edges(CREASE, manifold_edges=False, non_manifold_edges=False)
        if edges.n_points:
            plotter.add_mesh(edges, color=style.PALE, opacity=EDGE, line_width=FINER, lighting=False)

    def _light(self, plotter, camera: Camera) -> None:
        reach = np.linalg.norm(self.upper - self.lower)
        middle = (self.lower + self.upper) / 2
        sun = middle + reach * (2 * camera.up - camera.right - 0.7 * camera.ahead)
        for place, strength in ((sun, 0.5), (camera.eye, 0.6)):
            plotter.add_light(self._pv.Light(position=place, focal_point=middle, intensity=strength))


def _refuse_without_opengl(window) -> None:
    """Refused where VTK has come down to OSMesa, its last resort, and that is missing: it would crash."""
    if type(window).__name__ != "vtkOSOpenGLRenderWindow":
        return
    for name in ("libOSMesa.so", "libOSMesa.so.8", "libOSMesa.so.6"):
        try:
            ctypes.CDLL(name)
            return
        except OSError:
            pass
    raise Refused(NO_OPENGL)
