"""Thousands of wrong cases: each is refused in plain lines, or means what it says."""

import contextlib
import io
import json
import os
import resource
import subprocess
import sys
import time
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from drafts import SQUARE, TANK, WATER, refusal
from fuzzing import VALUES, Tally, fitting, spoilt, thorough
from hypothesis import given
from hypothesis import strategies as st
from jobs import clean_environment
from long import LONG, tell

from psph.__main__ import main
from psph.case import CaseError, load, schema
from psph.case.structure import alternatives, find, keys_of
from psph.errors import UNPRINTABLE, Foreseen
from psph.scene import Scene, checks

CASES = Path(__file__).parents[2] / "run" / "cases"
CORPUS = [path.read_bytes() for path in sorted(CASES.rglob("*.toml"))]
SCHEMA = schema()

MOST_SECONDS = 10.0
"""Of this process's own time; the machine may be busy with others."""

MOST_MEMORY = 2**20
"""More than before, KiB."""

SITES = 10**6
"""The limit on sites is lowered to these: a check looks at each of them."""


@pytest.fixture(autouse=True)
def few_sites(monkeypatch):
    """A case with more is refused, as one with 10¹¹ is."""
    monkeypatch.setattr(checks, "MOST_SITES", SITES)


def plain(lines, beginning):
    """Assert that each is one line of this beginning that a terminal can show."""
    assert lines
    for line in lines:
        assert line.startswith(str(beginning)), line
        assert len(line) < 1500 and not UNPRINTABLE.search(line) and "Traceback" not in line, line


def checked(path, *options):
    """``accepted`` or ``refused`` by the verb ``check``, in a while and in plain words."""
    before, begun = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                assert main(["check", str(path), *options]) == 0
        end = "accepted"
    except Foreseen as error:
        plain(error.lines, path)
        end = "refused"
    assert time.process_time() - begun < MOST_SECONDS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < MOST_MEMORY
    if end == "accepted":
        *remarks, good = said.getvalue().splitlines()
        assert good.startswith(f"{path}: good: ")
        assert all(remark.startswith(f"warning: {path}") for remark in remarks)
    return end


def means(written, resolved, where="case"):
    """Assert that each key of a file is found again in the case, with the value that it gave."""
    if written == "off" and resolved is None:
        return
    if isinstance(resolved, tuple) and isinstance(written, dict):
        [resolved] = resolved  # a motion of one part
    if isinstance(resolved, (tuple, list)) and isinstance(written, list):
        assert len(written) == len(resolved), where
        for k, (one, other) in enumerate(zip(written, resolved)):
            means(one, other, f"{where}[{k}]")
    elif isinstance(written, dict):
        fields = getattr(type(resolved), "model_fields", {})
        names = {field.alias or name: name for name, field in fields.items()}
        for key, value in written.items():
            inner = getattr(resolved, names[key]) if names else resolved[key]
            means(value, inner, f"{where}.{key}")
    elif hasattr(type(resolved), "model_fields"):  # a bare value: that of the first key
        means(written, getattr(resolved, next(iter(type(resolved).model_fields))), where)
    else:
        assert isinstance(written, bool) == isinstance(resolved, bool), where
        if isinstance(resolved, float):  # whole numbers of 64 bits are rounded, as decimals are
            assert np.isfinite(resolved), where
            written = float(written)
        assert written == resolved, where


def understood(path, folder):
    """Assert that an accepted case means what its file says, and its particles are numbers."""
    case = load(path)
    means(tomllib.loads(path.read_bytes().decode("utf-8-sig")), case)
    again = folder / "again.toml"
    again.write_text(case.to_toml(), encoding="utf-8")
    assert load(again).model_dump() == case.model_dump()
    scene = Scene(case)
    if scene.census.counts.sum() < 5000:
        made = scene.particles(0, scene.layout.planes, 0)
        assert all(np.isfinite(column).all() for column in vars(made).values())


def trial(folder, tally, data, *options):
    """One input: tried, and counted by its end."""
    path = folder / "case.toml"
    path.write_bytes(data)
    end = checked(path, *options)
    if end == "accepted" and not options:
        understood(path, folder)
    tally[end] += 1


def survived(tally, examples):
    """Both ends were met, by so many inputs as asked for."""
    tally.tell()
    assert tally.total() >= examples and min(tally["accepted"], tally["refused"]) > examples // 100


SPOILT = (100, pytest.param(5000, marks=LONG))


@pytest.mark.timeout(1500)
@pytest.mark.parametrize("examples", SPOILT)
def test_spoilt_texts(examples, tmp_path):
    tally = Tally()

    @thorough(examples)
    @given(spoilt(CORPUS))
    def run(data):
        trial(tmp_path, tally, data)

    run()
    survived(tally, examples)


@st.composite
def rewritten(draw, corpus=CORPUS, often=()):
    """A case with one to three keys given anew, by what the schema says of them."""
    case = tomllib.loads(draw(st.sampled_from(corpus)).decode())
    for _ in range(draw(st.integers(1, 3))):
        name = draw(st.sampled_from((*sorted(SCHEMA["properties"]), *often)))
        table, keys = case, (name,)
        if find(SCHEMA, (name, "NAME")):
            inner = draw(st.sampled_from([*case.get(name, {}), "new"]))
            table, keys = case.setdefault(name, {}), (name, inner)
        node = find(SCHEMA, keys)
        below = keys_of(SCHEMA, keys)
        if below and not any(b.get("type") == "array" for b in alternatives(SCHEMA, node)):
            table = table.setdefault(keys[-1], {})
            keys = (*keys, draw(st.sampled_from(below)))
            node = find(SCHEMA, keys)
        if isinstance(table, dict):
            table[keys[-1]] = draw(fitting(SCHEMA, node))
    return tomli_w.dumps(case).encode("utf-8", "replace")


@pytest.mark.timeout(1500)
@pytest.mark.parametrize("examples", SPOILT)
def test_values_that_the_schema_describes(examples, tmp_path):
    tally = Tally()

    @thorough(examples)
    @given(rewritten())
    def run(data):
        trial(tmp_path, tally, data)

    run()
    survived(tally, examples)


SMALL = [
    text.replace('scheme = "sph"', f'scheme = "{scheme}"').encode()
    for text in (TANK, WATER, SQUARE)
    for scheme in ("sph", "stable")
]
FEW = 600
"""Particles that plain Python can step."""


@pytest.fixture
def starts():
    """A function: a case's file → how its first steps ended, and what was said."""
    tests = Path(__file__).parents[1]
    with subprocess.Popen(
        [sys.executable, tests / "starting.py"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=clean_environment() | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    ) as job:

        def ask(path):
            job.stdin.write(f"{path}\n")
            job.stdin.flush()
            return json.loads(job.stdout.readline())

        yield ask
        job.stdin.close()


@pytest.mark.timeout(900)
@pytest.mark.parametrize("examples", (120, pytest.param(1200, marks=LONG)))
def test_what_is_accepted_starts(examples, tmp_path, starts):
    """No case that passed every check ends in a traceback: it runs, or is stopped in plain words."""
    tally, path = Tally(), tmp_path / "case.toml"

    @thorough(examples)
    @given(rewritten(SMALL, often=["physics"] * 20))
    def run(data):
        path.write_bytes(data)
        try:
            scene = Scene(load(path))
            checks.check(scene)
        except CaseError:
            tally["refused"] += 1
            return
        if scene.census.counts.sum() > FEW:
            tally["large"] += 1
            return
        end, said = starts(path)
        assert end != "broken", f"{data.decode()}\n{said}"
        tally[end] += 1

    run()
    tally.tell()
    tell("accepted cases started", tally["done"] + tally["stopped"])
    assert tally["done"] > examples // 20


@pytest.mark.parametrize("vector", ("gravity", "central_force.center"))
def test_no_vector_is_empty(vector, tmp_path):
    text = WATER.replace("gravity = [0.0, -9.8]", f"{vector} = []\ncentral_force.frequency = 1.0")
    assert any(vector in line for line in refusal(tmp_path, text))


def dotted_keys(node=SCHEMA, before=(), depth=3):
    """Keys of a case as a person writes them, with ``water`` for a name."""
    for branch in alternatives(SCHEMA, node):
        named = [("water", n) for n in branch.get("patternProperties", {}).values()]
        for name, below in (*branch.get("properties", {}).items(), *named):
            yield ".".join((*before, name))
            if depth > 1:
                yield from dotted_keys(below, (*before, name), depth - 1)


KEYS = sorted(set(dotted_keys()))
WRITTEN = st.sampled_from([v.decode() for v in VALUES])
SIZES = st.one_of(st.floats(0.0, 1.0), st.floats()).map(repr)
DAM_BREAK = (CASES / "dam_break.toml").read_bytes().partition(b"[experiments")[0]
"""Without its experiment, whose file would lie elsewhere."""
AT_HAND = [key for key in KEYS if key.partition(".")[0] in tomllib.loads(DAM_BREAK.decode())]
"""Keys of the tables that it has: most others lack what their table needs."""


def assigned(keys):
    """Overrides of some keys."""
    return st.builds("{}={}".format, st.sampled_from(keys), st.one_of(WRITTEN, SIZES))


OVERRIDES = st.one_of(
    assigned(KEYS),
    assigned(AT_HAND),
    assigned(AT_HAND),
    st.text(max_size=20),
    st.sampled_from(KEYS),
    st.builds("{}.{}=1".format, st.sampled_from(KEYS), st.text(max_size=3)),
).filter(lambda text: not text.startswith("-"))


@pytest.mark.timeout(600)
@pytest.mark.parametrize("examples", (100, pytest.param(2000, marks=LONG)))
def test_overrides(examples, tmp_path):
    tally = Tally()

    @thorough(examples)
    @given(st.lists(OVERRIDES, min_size=1, max_size=2))
    def run(given_):
        trial(tmp_path, tally, DAM_BREAK, *(part for one in given_ for part in ("--set", one)))

    run()
    survived(tally, examples)


@pytest.mark.timeout(600)
@pytest.mark.parametrize("examples", (50, pytest.param(1000, marks=LONG)))
def test_extensions(examples, tmp_path):
    """``resume --set`` of a folder without a checkpoint: refused, in one way or the other."""
    (tmp_path / "case.toml").write_bytes((CASES / "dam_break.toml").read_bytes())
    tally = Tally()
    fit = ("time.end", "output.", "guards.", "checkpoint.")
    keys = st.sampled_from([key for key in KEYS if key.startswith(fit)])
    further = st.builds("{}={}".format, keys, st.one_of(SIZES, WRITTEN))

    @thorough(examples)
    @given(st.one_of(OVERRIDES, further, further, st.just("time.end=3.0")))
    def run(text):
        with pytest.raises(Foreseen) as caught:
            main(["resume", str(tmp_path), "--set", text])
        end = "refused" if isinstance(caught.value, CaseError) else "without a checkpoint"
        said = str(caught.value)
        plain(said.split("\n"), "--set " if "another run" in said else tmp_path)
        tally[end] += 1

    run()
    tally.tell()
    assert tally["refused"] and tally["without a checkpoint"]


@pytest.mark.timeout(900)
@pytest.mark.parametrize("examples", (3, pytest.param(40, marks=LONG)))
def test_real_processes(examples, tmp_path):
    """The same on the command line: code 0 or 2, and no traceback."""
    tally, path = Tally(), tmp_path / "case.toml"

    @thorough(examples)
    @given(spoilt(CORPUS))
    def run(data):
        path.write_bytes(data)
        job = subprocess.run(
            [sys.executable, "-m", "psph", "check", path],
            capture_output=True,
            text=True,
            env=clean_environment(),
            stdin=subprocess.DEVNULL,
            timeout=60,
        )
        if job.returncode:
            assert job.returncode == 2
            plain(job.stderr.splitlines(), path)
        tally["refused" if job.returncode else "accepted"] += 1

    run()
    tally.tell()


@pytest.mark.parametrize(
    "written, resolved",
    [
        ({"title": "a"}, {"title": "b"}),
        ({"x": [1.0]}, {"x": [1.0, 2.0]}),
        ({"x": 1}, {"x": True}),
        ({"x": float("inf")}, {"x": float("inf")}),
    ],
)
def test_another_meaning_is_seen(written, resolved):
    """The control: what the trials would not accept."""
    with pytest.raises(AssertionError):
        means(written, resolved)


def test_an_ignored_key_is_seen():
    """The control: a key that the case does not have."""
    with pytest.raises(KeyError):
        means({"speed": 1.0}, {"velocity": 1.0})
