"""Reading files and overriding keys."""

import subprocess
import sys

import pytest
from drafts import WATER, draft, refusal

from psph.case import CaseError, load
from psph.errors import one_line


@pytest.mark.parametrize("name", ["load", "Case", "CaseError", "schema"])
def test_every_public_name_is_there(name):
    import psph.case

    assert getattr(psph.case, name).__name__ == name


def test_an_unknown_name_of_the_package_is_an_attribute_error():
    import psph.case

    with pytest.raises(AttributeError, match="no attribute 'lode'"):
        psph.case.lode


def test_importing_is_cheap():
    heavy = {"numba", "matplotlib", "rich", "pydantic", "mpi4py"}
    code = f"import sys, psph.case; print(sorted({heavy} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_file_and_name_are_those_given(tmp_path):
    case = draft(tmp_path)
    assert case.file == str(tmp_path / "case.toml")
    assert case.name == "case"


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(CaseError) as caught:
        load(tmp_path / "none.toml")
    [line] = caught.value.lines
    assert line.startswith(f"{tmp_path}/none.toml: No such file")
    assert "give the path of a case in TOML" in line


def test_a_folder_is_one_line(tmp_path):
    with pytest.raises(CaseError, match="Is a directory; give the path of a case"):
        load(tmp_path)


def test_a_file_that_is_no_text_is_one_line(tmp_path):
    (tmp_path / "case.toml").write_bytes(b"title = '\xff'")
    with pytest.raises(CaseError, match="case.toml: byte 9 is not UTF-8; save the file as UTF-8"):
        load(tmp_path / "case.toml")


def test_a_byte_order_mark_and_windows_line_ends_are_read(tmp_path):
    path = tmp_path / "case.toml"
    path.write_bytes(b"\xef\xbb\xbf" + WATER.replace("\n", "\r\n").encode())
    assert load(path).space.spacing == 0.1


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[space]\nspacing = 0,1\n", "line 2: 'spacing = 0,1': expected newline"),
        ("[space]\nlower = [0.0, -9,05]\n", "line 2: 'lower = [0.0, -9,05]': unclosed array"),
        ("[space\n", "line 1: '[space': expected ']'"),
        ("a = 1\nb = ", "line 2: 'b =': invalid value"),
        ('title = "open', "line 1: 'title = \"open': unterminated string"),
        ("a = 1\n\na = 2\n", "line 3: 'a = 2': cannot overwrite a value"),
    ],
)
def test_a_syntax_error_is_one_line_with_its_place(tmp_path, text, says):
    [line] = refusal(tmp_path, text)
    assert line.startswith(f"case.toml: {says}")
    assert "correct this line" in line or line.endswith(
        ("a decimal point, not a comma: 0.1", "a decimal point, not a comma: -9.05")
    )


@pytest.mark.parametrize(
    ("text", "how"),
    [
        ("space = { spacing = 0.1 }\n[[space.refine]]\n", "write [space] with a line for each of its keys"),
        ("space = { spacing = 0.1 }\nspace.kernel = 1\n", "write [space] with a line for each of its keys"),
        ("a.b = { c = 1 }\n[a.b.d]\ne = 1\n", "write [a.b] with a line for each of its keys"),
        ("time.end = 1.0\n[time]\ncfl = 0.1\n", "time has keys above: add these there"),
        ("[a.b]\nc = 1\n[d]\n[a.b]\ne = 1\n", "a.b has keys above: add these there"),
    ],
)
def test_keys_for_a_table_that_stands_above_are_told_where_to_go(tmp_path, text, how):
    [line] = refusal(tmp_path, text)
    assert how in line and "for example" not in line


@pytest.mark.parametrize(
    ("override", "found"),
    [
        ("time.end=0.5", lambda case: case.time.end == 0.5),
        ("time.end = 1", lambda case: case.time.end == 1.0),
        ("space.kernel=cubic", lambda case: case.space.kernel == "cubic"),
        ("space.kernel='wendland-c2'", lambda case: case.space.kernel == "wendland-c2"),
        ("fluids.water.velocity=[1, 0]", lambda case: case.fluids["water"].velocity == (1.0, 0.0)),
        ("physics.free_surface=0.9", lambda case: case.physics.free_surface.threshold == 0.9),
        ("title=a b = c", None),
        ("title='a b = c'", lambda case: case.title == "a b = c"),
    ],
)
def test_an_override_replaces_a_key(tmp_path, override, found):
    if found is None:
        [line] = refusal(tmp_path, WATER, override)
        assert "'a b = c' is not a value; write it as in TOML" in line
    else:
        assert found(draft(tmp_path, WATER, override))


def test_an_override_reaches_into_a_list(tmp_path):
    text = WATER + "[[perturbations]]\nposition = [0.0, 0.0]\nvelocity = [1.0, 0.0]\n"
    case = draft(tmp_path, text, "perturbations.0.velocity=[2.0, 0.0]")
    assert case.perturbations[0].velocity == (2.0, 0.0)


@pytest.mark.parametrize("key", ["perturbations[0].velocity", "perturbations.0.velocity"])
def test_a_place_in_a_list_is_written_as_in_messages_or_with_a_dot(tmp_path, key):
    text = WATER + "[[perturbations]]\nposition = [0.0, 0.0]\nvelocity = [1.0, 0.0]\n"
    case = draft(tmp_path, text, f"{key}=[2.0, 0.0]", f"{key}[1]=3.0")
    assert case.perturbations[0].velocity == (2.0, 3.0)
    [line] = refusal(tmp_path, text, f"{key}=[2.0]")
    assert f"--set {key}=[2.0]: perturbations[0].velocity: [2.0]: 1 number" in line
    [line] = refusal(tmp_path, text, "perturbations[1].velocity=[2.0, 0.0]")
    assert "perturbations: has no [1] inside" in line


def test_a_later_override_wins(tmp_path):
    assert draft(tmp_path, WATER, "time.end=3.0", "time.end=4.0").time.end == 4.0


def test_a_direction_is_a_word(tmp_path):
    text = WATER + '[ends.mouth]\nat = 0.0\ninward = "+x"\npressure = 0.0\n'
    assert draft(tmp_path, text, "ends.mouth.inward=-x").ends["mouth"].inward == "-x"


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("time.end", "no key and value; write it as key.key=value"),
        ("time..end=1", "no key and value; write it as key.key=value"),
        ("space.spacing=0,02", "'0,02' is not a value; a decimal point, not a comma: 0.02"),
        ("time.end=1..2", "'1..2' is not a value; write it as in TOML"),
        ("time.end=1\nstep = 2", "is not a value; write it as in TOML"),
        ("time.end.x=1", "time.end: has no x inside; override time.end itself"),
        ("time.cfl=2", "time.cfl: 2 is out of range"),
        ("time.cfll=0.2", "time.cfll: unknown key; did you mean 'cfl'?"),
        ("fluids.oil.density=900", "fluids.oil.shape: missing"),
        ("fluids.water.shape.box.lower=[2, 2]", "fluids.water.shape.box: has no inside"),
    ],
)
def test_a_bad_override_is_named(tmp_path, override, says):
    [line] = refusal(tmp_path, WATER, override)
    assert line.startswith(f"case.toml with --set {one_line(override)}: ")
    assert says in line


def test_a_fault_of_the_file_is_not_laid_on_an_override(tmp_path):
    [line] = refusal(tmp_path, WATER.replace("end = 2.0", "end = -2.0"), "space.spacing=0.2")
    assert line.startswith("case.toml: time.end: -2.0 is out of range")
