"""Phantom, from a folder of its sources: one step for all, particles by a small setup of ours."""

import re
import statistics
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from psph.lab.bench import GAS
from psph.lab.errors import PeersError
from psph.lab.peers.gas import DIMENSIONS, END, LONG, SHORT, GasPace, GasStart, between, check_end
from psph.lab.peers.process import LOG, finished
from psph.lab.peers.sources import Sources, first_of

PATIENCE = 7200.0

REACH = 2.0
"""How far its Wendland C2 reaches, over its smoothing length."""

COMPILERS = ("gfortran", "gfortran-14", "gfortran-13", "gfortran-12", "gfortran-11")

NEEDS = "gfortran, gcc and make"

FLAGS = "-march=native -flto"
"""Beside its own: the fastest of what was tried."""

CHOICES = ("SYSTEM=gfortran", "SETUP=sedov", "CONST_AV=yes", "KERNEL=WendlandC2")

TOGETHER, APART = "IND_TIMESTEPS=no", "IND_TIMESTEPS=yes"
"""One step for all, or steps of each particle's own: chosen as it is built."""

LONGEST = 0.005
"""Between its outputs as in its own blast, which is also its longest step of their own, s."""

BLAST, OPTIONS = "blast.txt", "blast.in"
"""The particles and its file of options, in the folder of a run."""

SETUP = "setup_peers.f90"

SETUP_TEXT = f"""\
! Particles of one mass at rest in a periodic cube around 0, 1 wide, of density 1:
! {BLAST} has their number and h over the spacing in its first line, then x y z u of each.
module setup
 implicit none
 private
 public :: setpart
contains
 subroutine setpart(rank,n,numbers,places,masses,motion,k_poly,adiabatic,h_spacings,t,prefix)
  use boundary,     only:set_boundary
  use options,      only:alphau
  use part,         only:hfact,igas,set_particle_type
  use setup_params, only:npart_total,rhozero
  use timestep,     only:dtmax,tmax
  integer, intent(in)    :: rank
  integer, intent(out)   :: n,numbers(:)
  real,    intent(out)   :: places(:,:),masses(:),motion(:,:),k_poly,adiabatic,h_spacings
  real,    intent(inout) :: t
  character(len=20), intent(in) :: prefix
  integer :: file,k

  call set_boundary(-0.5,0.5,-0.5,0.5,-0.5,0.5)
  motion = 0.
  open(newunit=file,file='{BLAST}',status='old',action='read')
  read(file,*) n,h_spacings
  do k=1,n
     read(file,*) places(1:3,k),motion(4,k)
     places(4,k) = h_spacings/real(n)**(1./3.)
     call set_particle_type(k,igas)
  enddo
  close(file)

  numbers       = 0
  numbers(igas) = n
  masses        = 0.
  masses(igas)  = 1./real(n)
  npart_total   = n
  rhozero   = 1.
  hfact     = h_spacings
  alphau    = 1.
  adiabatic = 5./3.
  k_poly    = 0.
  t         = 0.
  tmax      = 1.
  dtmax     = 1.
 end subroutine setpart
end module setup
"""

STEP = re.compile(r"^ t = +\S+ dt = ", re.MULTILINE)
WITH_ITSELF = re.compile(r"real neigh mean = +(\S+)")
"""What it prints of each step."""
OUTPUT = re.compile(r"TIME = +([\d.E+-]+)")
"""What it prints of each output, one of which is at the end."""


class Phantom:
    """Phantom as built from the ``sources`` in a ``folder`` of ours."""

    name = "Phantom"
    scheme = "α = 1 everywhere, a new tree in each step; double precision"
    objections = {
        GAS: "it is meant for ifort and for many cores, with steps of each particle's own, and with its "
        "switch of the viscosity, which is off here."
    }

    def __init__(self, sources: Path, folder: Path):
        files = ("build/Makefile", "src/main", "src/setup")
        self.built = {
            steps: Sources(self.name, "--phantom", sources, folder / name, files)
            for steps, name in ((TOGETHER, "together"), (APART, "apart"))
        }

    def prepare(self) -> str:
        """Build what is missing; the commit of the sources, or that they have none."""
        for steps, sources in self.built.items():
            sources.build(NEEDS, {f"src/setup/{SETUP}": SETUP_TEXT}, self.steps(steps))
        return self.built[TOGETHER].version()

    def steps(self, choice: str) -> list[list[str]]:
        """The commands that build it and its setup, with a ``choice`` of steps.  PeersError: no compiler."""
        compiler = Path(first_of(*COMPILERS)).name
        if not compiler:
            raise PeersError("Phantom is not built: no gfortran on the path; install it")
        archive = compiler.replace("gfortran", "gcc-ar") + " rcs"  # plain ar does not see what -flto leaves
        words = ["env", f"FFLAGS={FLAGS}", "make", *CHOICES, choice, f"SETUPFILE={SETUP}"]
        words += [f"FC={compiler}", f"LIBTOOL={archive}"]
        return [words, [*words, "setup"]]

    def pace(self, start: GasStart, folder: Path) -> GasPace:
        """Its pace: the same start for ``SHORT`` and for ``LONG`` steps, and until ``END``."""
        spent, told = {}, ""
        for steps in (SHORT, LONG):
            changes = {"nmax": steps, "iverbose": 2}
            told, seconds = self.run(start, TOGETHER, changes, folder / str(steps))
            spent[steps] = len(start.heat) * made(told, steps), seconds
        log, own = self.run(start, APART, {"tmax": END, "dtmax": LONGEST}, folder / "own")
        check_end(self.name, ended(log), folder)
        return between(self.name, spent[SHORT], spent[LONG], neighbours(told), own)

    def run(self, start: GasStart, steps: str, changes: Mapping, folder: Path) -> tuple[str, float]:
        """A run of the build with such ``steps``: what it printed, and CPU seconds of the whole process."""
        folder.mkdir(parents=True)
        write(start, folder / BLAST)
        room = f"--maxp={round(1.1 * len(start.heat))}"
        programs, prefix = self.built[steps].copy / "bin", OPTIONS.partition(".")[0]
        self.finish("its setup", [programs / "phantomsetup", prefix, room], folder)
        options = folder / OPTIONS
        options.write_text(as_asked(options.read_text(encoding="utf-8"), changes), encoding="utf-8")
        seconds = self.finish(folder.name, [programs / "phantom", OPTIONS, room], folder)
        return (folder / LOG).read_text(encoding="utf-8", errors="replace"), seconds

    def finish(self, what: str, words: list, folder: Path) -> float:
        """CPU seconds of one of its programs, which keeps whole arrays on the stack."""
        widest = ["sh", "-c", 'ulimit -s "$(ulimit -H -s)"; exec "$0" "$@"']
        more = {"OMP_STACKSIZE": "512M"}
        return finished(f"Phantom, {what}", [*widest, *words], folder, PATIENCE, more)


def write(start: GasStart, file: Path) -> None:
    """The particles as our setup reads them."""
    n = len(start.heat)
    head = f"{n} {start.support / REACH * n ** (1.0 / DIMENSIONS):.17g}"
    rows = np.column_stack([start.position, start.heat])
    np.savetxt(file, rows, fmt="%.17g", header=head, comments="")


def as_asked(options: str, changes: Mapping) -> str:
    """Its file of options with these ``changes`` by key.  PeersError: it has other options."""
    for key, value in changes.items():
        options, found = re.subn(rf"(?m)^( *{key} *= *)\S+", rf"\g<1>{value}", options)
        if found != 1:
            raise PeersError(
                f"Phantom: no single {key} in {OPTIONS}; its sources have changed since f68ddd740"
            )
    return options


def made(log: str, steps: int) -> int:
    """The ``steps`` once its log has them all.  PeersError: it has others."""
    told = len(STEP.findall(log))
    if told != steps:
        raise PeersError(f"Phantom: {told} steps in its log in place of {steps}; see {LOG} of its run")
    return steps


def ended(log: str) -> float:
    """The time of its last output, s; 0: it has none."""
    return max(map(float, OUTPUT.findall(log)), default=0.0)


def neighbours(log: str) -> str:
    """How many others it had on average over the steps that count."""
    told = [float(number) for number in WITH_ITSELF.findall(log)[SHORT:]]
    return f"{statistics.fmean(told) - 1.0:.0f}" if told else "–"
