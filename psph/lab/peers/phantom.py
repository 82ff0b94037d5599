"""Phantom, from a folder of its sources: one step for all, particles by a small setup of ours."""

import re
import statistics
from pathlib import Path

import numpy as np

from psph.lab.bench import GAS
from psph.lab.errors import PeersError
from psph.lab.peers.gas import DIMENSIONS, LONG, SHORT, GasPace, GasStart, between
from psph.lab.peers.process import LOG, finished
from psph.lab.peers.sources import Sources, first_of

PATIENCE = 7200.0

REACH = 2.0
"""How far its Wendland C2 reaches, over its smoothing length."""

COMPILERS = ("gfortran", "gfortran-14", "gfortran-13", "gfortran-12", "gfortran-11")

NEEDS = "gfortran, gcc and make"

FLAGS = "-march=native -flto"
"""Beside its own: the fastest of what was tried."""

CHOICES = ("SYSTEM=gfortran", "SETUP=sedov", "IND_TIMESTEPS=no", "CONST_AV=yes", "KERNEL=WendlandC2")

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


class Phantom:
    """Phantom as built from the ``sources`` in a ``folder`` of ours."""

    name = "Phantom"
    scheme = "α = 1 everywhere, a new tree in each step, one step for all; double precision"
    objections = {
        GAS: "it is meant for ifort and for many cores, with steps of each particle's own; its switch of the "
        "viscosity is off here, and a new tree in each step serves gravity, which this gas has not."
    }

    def __init__(self, sources: Path, folder: Path):
        files = ("build/Makefile", "src/main", "src/setup")
        self.sources = Sources(self.name, "--phantom", sources, folder, files)
        self.programs = self.sources.copy / "bin"

    def prepare(self) -> str:
        """Build what is missing; the commit of the sources, or that they have none."""
        self.sources.build(NEEDS, {f"src/setup/{SETUP}": SETUP_TEXT}, self.steps())
        return self.sources.version()

    def steps(self) -> list[list[str]]:
        """The commands that build it and its setup.  PeersError: no compiler."""
        compiler = Path(first_of(*COMPILERS)).name
        if not compiler:
            raise PeersError("Phantom is not built: no gfortran on the path; install it")
        archive = compiler.replace("gfortran", "gcc-ar") + " rcs"  # plain ar does not see what -flto leaves
        words = ["env", f"FFLAGS={FLAGS}", "make", *CHOICES, f"SETUPFILE={SETUP}"]
        words += [f"FC={compiler}", f"LIBTOOL={archive}"]
        return [words, [*words, "setup"]]

    def pace(self, start: GasStart, folder: Path) -> GasPace:
        """Its pace: the same start for ``SHORT`` and for ``LONG`` steps."""
        spent = {steps: self.run(start, steps, folder / str(steps)) for steps in (SHORT, LONG)}
        log = (folder / str(LONG) / LOG).read_text(encoding="utf-8", errors="replace")
        return between(self.name, spent[SHORT], spent[LONG], neighbours(log))

    def run(self, start: GasStart, steps: int, folder: Path) -> tuple[int, float]:
        """So many steps: updates of a particle, and CPU seconds of the whole process."""
        folder.mkdir(parents=True)
        write(start, folder / BLAST)
        room = f"--maxp={round(1.1 * len(start.heat))}"
        prefix = OPTIONS.partition(".")[0]
        self.finish("its setup", [self.programs / "phantomsetup", prefix, room], folder)
        options = folder / OPTIONS
        options.write_text(as_asked(options.read_text(encoding="utf-8"), steps), encoding="utf-8")
        seconds = self.finish(f"{steps} steps", [self.programs / "phantom", OPTIONS, room], folder)
        return len(start.heat) * made((folder / LOG).read_text(errors="replace"), steps), seconds

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


def as_asked(options: str, steps: int) -> str:
    """Its file of options with so many steps, each of which it tells.  PeersError: it has other options."""
    for key, value in {"nmax": steps, "iverbose": 2}.items():
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


def neighbours(log: str) -> str:
    """How many others it had on average over the steps that count."""
    told = [float(number) for number in WITH_ITSELF.findall(log)[SHORT:]]
    return f"{statistics.fmean(told) - 1.0:.0f}" if told else "–"
