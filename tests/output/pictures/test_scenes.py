"""Scenes in 3D as pictures: what is seen of them, and what is said where they cannot be drawn."""

import os
import subprocess
import sys

import h5py
import numpy as np
import pytest
from matplotlib.image import imread

from psph.errors import Refused
from psph.output.errors import NotThere
from psph.output.frames import FrameFile
from psph.output.pictures import style
from psph.output.pictures.camera import before, corners_of, directions
from psph.output.pictures.flat import Slice, slice_of
from psph.output.pictures.plot import plot
from psph.output.pictures.quantities import quantity
from psph.output.pictures.show import Show
from psph.output.reader import Run


def saturation(image):
    """How far from grey each pixel is, 0 to 1."""
    return np.ptp(image[..., :3], axis=-1)


def image_of(show, k, size=(400, 260)):
    camera = before(show.panel.lower, show.panel.upper, show.panel._axes, size[0] / size[1])
    return show.panel.image(show.frame(k), show.scale, camera, list(size)), camera


@pytest.mark.parametrize("smooth", [False, True])
def test_a_scene_is_a_picture_with_water_and_walls(tank3d, smooth):
    paths = plot(tank3d.folder, [0.5], "speed", smooth=smooth)
    assert [path.name for path in paths] == [f"velocity{'_surface' * smooth}_00001.png", "overview.png"]
    for path in paths:
        image = imread(path)
        page = image[: int(0.85 * len(image)), : int(0.85 * image.shape[1])]  # without the bar of colours
        assert 0.03 < (saturation(page) > 0.15).mean() < 0.6  # the fluid
        grey = (saturation(page) < 0.03) & (page[..., 0] > 0.7) & (page[..., 0] < 0.98)
        assert 0.1 < grey.mean() < 0.8  # walls


def test_particles_are_where_the_camera_sees_them(tank3d):
    show = Show(tank3d, [0.0], "speed")
    image, camera = image_of(show, 0, (600, 400))
    frame = show.frame(0)
    fluid = frame["position"][frame["kind"] == 0]
    hidden = saturation(image / 255) < 0.1
    nearest = fluid[np.argsort(np.linalg.norm(fluid - camera.eye, axis=1))[:12]]
    across, up = (camera.seen(nearest) * [600, 400]).T
    assert not hidden[(400 - up).astype(int), across.astype(int)].any()
    rows, columns = np.nonzero(~hidden)
    low, high = camera.seen(fluid).min(axis=0) * [600, 400], camera.seen(fluid).max(axis=0) * [600, 400]
    assert columns.min() == pytest.approx(low[0], abs=25) and columns.max() == pytest.approx(high[0], abs=25)
    assert 400 - rows.max() == pytest.approx(low[1], abs=25) and 400 - rows.min() == pytest.approx(
        high[1], abs=25
    )


def test_a_colour_means_the_same_in_all_frames(tank3d):
    first, last = Show(tank3d, [0.0], "speed"), Show(tank3d, [1.0], "speed")
    assert (first.scale.norm.vmin, first.scale.norm.vmax) == (last.scale.norm.vmin, last.scale.norm.vmax)
    assert first.scale.norm.vmax > 1.3 * first.frame(0)["values"].max()
    assert np.array_equal(first.panel.lower, last.panel.lower)
    values = np.linspace(0, 2, 5)
    assert np.array_equal(first.scale.rgb(values), last.scale.rgb(values))
    assert (np.diff(first.scale.rgb(values) @ [0.299, 0.587, 0.114]) > 0).all()  # survives a grey print


def test_fluids_have_their_names_for_a_key(tank3d):
    show = Show(tank3d, [0.0], "group")
    figure = show.picture([0])
    [legend] = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    assert [text.get_text() for text in legend.get_texts()] == ["water", "a_light_crude_oil"]
    renderer = figure.canvas.get_renderer()
    assert legend.get_window_extent(renderer).x1 < figure.bbox.x1  # names have room on the page
    image, _ = image_of(show, 0)
    for name, colour in zip(("water", "a_light_crude_oil"), style.LINES):
        hue = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], float)
        alike = (image @ hue) / (np.linalg.norm(image, axis=-1) * np.linalg.norm(hue) + 1e-9)
        assert ((alike > 0.99) & (saturation(image / 255) > 0.2)).mean() > 0.005, name


def test_vorticity_of_a_frame_is_that_of_its_fluid(tank3d):
    show = Show(tank3d, [1.0], "vorticity")
    frame = show.frame(2)
    assert np.isnan(frame["values"][frame["kind"] == 1]).all()
    assert frame["values"][frame["kind"] == 0] == pytest.approx(3.0)  # its velocity is 3 x, along y
    assert (show.scale.title, show.scale.unit) == ("vorticity", "1/s")


@pytest.mark.parametrize("smooth", [False, True])
def test_a_scene_that_blew_up_can_still_be_seen(tank3d, alone, smooth):
    case, sound = tank3d.case_text, tank3d.frame(0)
    frames = FrameFile(tank3d.path, alone, {"case": case})
    fluid = np.flatnonzero(sound["kind"] == 0)
    thrown, lost = sound["position"].copy(), sound["position"].copy()
    thrown[fluid[:3]] = [[1e9, 0, 1e9], [np.nan, 0, 0], [np.inf, 1, 1]]
    lost[fluid] = np.nan
    for k, position in enumerate((sound["position"], thrown, lost)):
        frames.write(k, 0.5 * k, k, sound | {"position": position})
    show = Show(Run(tank3d.folder), None, "pressure", smooth=smooth)
    assert np.ptp([show.panel.lower, show.panel.upper], axis=0).max() < 4.0
    wet = [(saturation(image_of(show, k)[0] / 255) > 0.15).mean() for k in range(3)]
    assert wet[1] == pytest.approx(wet[0], rel=0.2) and wet[0] > 0.005 and wet[2] == 0.0


def test_a_camera_sees_all_of_a_box_and_no_more():
    lower, upper = np.array([0.0, -1.0, 2.0]), np.array([3.0, 0.0, 2.5])
    for up, sense, across in ((2, 1, 0), (2, 1, 1), (1, 1, 0), (1, -1, 2)):
        axes = directions(up, sense, across)
        assert np.linalg.det(np.array(axes)) == pytest.approx(-1.0)  # not the mirror image of the scene
        for aspect in (None, 0.8, 3.0):
            camera = before(lower, upper, axes, aspect)
            seen = camera.seen(corners_of(lower, upper))
            assert seen.min() > -1e-3 and seen.max() < 1 + 1e-3
            spans = np.ptp(seen, axis=0)
            assert spans.max() == pytest.approx(1.0, abs=1e-3)
            assert aspect or spans.min() == pytest.approx(1.0, abs=1e-3)
        assert camera.eye[up] * sense > (upper if sense > 0 else -lower)[up]  # from above
        assert camera.up[up] * sense > 0.9


def test_planes_are_read():
    assert slice_of("y=0.5") == Slice(1, 0.5) and slice_of("z=-1e-2") == Slice(2, -0.01)
    for text in ("y", "w=1", "y=half", "y=nan", "=1", "y=\n1;"):
        with pytest.raises(
            Refused, match="not a plane; write an axis and a place in m, such as y=0.5"
        ) as error:
            slice_of(text)
        assert "\n" not in str(error.value)


def test_what_a_scene_lacks_is_one_line(tank3d, monkeypatch):
    with pytest.raises(NotThere, match="--slice y=9: there are particles from -0.1 to 0.7 m; give a place"):
        Show(tank3d, None, "speed", Slice(1, 9.0))
    with pytest.raises(Refused, match="--surface: a slice has none"):
        Show(tank3d, None, "speed", Slice(1, 0.3), smooth=True)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(
        Refused, match="needs pyvista, which is not installed: `pip install pyvista`; or look"
    ):
        plot(tank3d.folder)
    assert [path.name for path in plot(tank3d.folder, [0.0], cut=Slice(1, 0.3))][
        0
    ] == "pressure_slice_00000.png"


def test_what_only_a_scene_has_is_refused_of_a_plane(tank3d):
    flat = quantity(
        tank3d,
        {"space": {"dimensions": 3, "spacing": 1, "smoothing": 1}, "fluids": {"water": {"density": 1000.0}}},
        "vorticity",
    )
    assert not flat.signed  # in 3D it is a size
    with pytest.raises(NotThere, match="a flow along one axis has none"):
        quantity(tank3d, {"space": {"dimensions": 1}}, "vorticity")


def command(folder, *options, **environment):
    """``plot`` on a machine without a screen."""
    quiet = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    words = [sys.executable, "-m", "psph", "plot", str(folder), *options]
    return subprocess.run(words, capture_output=True, text=True, env=quiet | environment, timeout=60)


def test_no_screen_is_needed(tank3d):
    job = command(tank3d.folder, "--field", "speed", "--times", "0.5")
    assert (job.returncode, job.stderr) == (0, "")
    assert imread(job.stdout.split()[0]).std() > 0.05


def test_without_opengl_it_is_one_line(tank3d):
    job = command(tank3d.folder, __EGL_VENDOR_LIBRARY_DIRS="/nonexistent")
    if job.returncode == 0:
        pytest.skip("VTK finds OSMesa here")
    assert job.returncode == 2 and job.stderr.count("\n") == 1
    assert "needs OpenGL, and VTK finds none: install Mesa's EGL" in job.stderr


def test_a_folder_without_a_run_is_a_mistake_in_the_command(tmp_path):
    job = command(tmp_path)
    assert job.returncode == 2 and job.stderr.count("\n") == 1
    assert "holds one file of frames (.h5), here: none" in job.stderr
    assert isinstance(pytest.raises(NotThere, Run, tmp_path).value, Refused)


def with_body(run):
    """The same run, whose block is a rigid body."""
    case = run.case_text.replace("walls.block", "bodies.block")
    with h5py.File(run.path, "r+", locking=False) as file:
        file.attrs["case"] = case
    return Run(run.folder)


def brown(image):
    """Pixels (height, width) of the hue of bodies, lit or in the shade."""
    hue = np.array([int(style.WHOLE[k : k + 2], 16) for k in (1, 3, 5)], float)
    rgb = image[..., :3].astype(float)
    return (rgb @ hue) / (np.linalg.norm(rgb, axis=-1) * np.linalg.norm(hue) + 1e-9) > 0.998


@pytest.mark.parametrize("cut", [None, Slice(1, 0.35)])
def test_bodies_have_a_colour_of_their_own_and_a_name(tank3d, cut):
    def drawn(run):
        figure = Show(run, [0.0], "group", cut).picture([0])
        figure.canvas.draw()
        [legend] = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
        page = np.asarray(figure.canvas.buffer_rgba())
        return [text.get_text() for text in legend.get_texts()], page[:, : int(0.75 * page.shape[1])]

    names, page = drawn(tank3d)
    assert names == ["water", "a_light_crude_oil"] and brown(page).mean() < 0.001
    names, page = drawn(with_body(tank3d))
    assert names == ["water", "a_light_crude_oil", "block"] and brown(page).mean() > 0.005
