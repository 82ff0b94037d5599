"""Progress of a run: a live bar on a terminal, plain lines in a log file."""

import math
import os
import sys
from collections import deque
from collections.abc import Collection, Iterator
from time import perf_counter
from typing import NamedTuple, TypeVar

T = TypeVar("T")

TICK = 0.2
"""Seconds of wall-clock time between two looks at the rate (and two pictures of the bar)."""
WINDOW = 10.0
"""Seconds of wall-clock time over which rates are taken."""
PATIENCE = 30.0
"""Most seconds between two plain lines."""


class _Sample(NamedTuple):
    wall: float
    time: float
    step: int


class Progress:
    """Reports how far a run to ``end_time`` (s) with ``particles`` particles in all has come.

    Rank 0 alone prints; the other ranks may call it all the same.  Without ``lines`` it shows
    nothing but the bar on a terminal.
    """

    def __init__(self, comm, end_time: float, title: str, particles: int, lines: bool = True):
        self.end_time, self.title, self.particles, self.lines = end_time, title, particles, lines
        self._samples: deque[_Sample] = deque()
        self._bar = None
        self._due = self._next = math.inf  # wall-clock and simulated time of the next report
        if comm.rank == 0:
            self._due, self._next, self._said = 0.0, self._milestone(0.0), perf_counter()
            width = terminal_width()
            self._bar = _Bar(width) if width else None

    def update(self, time: float, step: int, dt: float, speed: float) -> None:
        """Call it after each step; it costs less than a microsecond when nothing is due.

        ``speed`` is the largest of all particles that flow or bend, m/s.
        """
        now = perf_counter()
        if now < self._due and time < self._next:
            return
        self._due = now + TICK
        self._samples.append(_Sample(now, time, step))
        while len(self._samples) > 2 and now - self._samples[1].wall > WINDOW:
            self._samples.popleft()
        if self._bar:
            self._bar.show(self.title, min(time / self.end_time, 1.0), *self._report(dt, speed))
        elif self.lines and (time >= self._next or now - self._said > PATIENCE):
            report, left = self._report(dt, speed)
            print(f"{min(time / self.end_time, 1.0):4.0%}  t {time:.4g} s  {report}  {left}", flush=True)
            self._said = now
        if time >= self._next:
            self._next = self._milestone(time)

    def close(self) -> None:
        """Stop the bar and release the terminal; a second call does nothing."""
        self._due = self._next = math.inf
        if self._bar:
            self._bar.close()
            self._bar = None

    def _milestone(self, time: float) -> float:
        """The next tenth of the way after ``time``; rounding must not miss the last one."""
        tenth = math.floor(10 * time / self.end_time + 1e-6) + 1
        return tenth / 10 * self.end_time * (1 - 1e-9) if tenth <= 10 else math.inf

    def _report(self, dt: float, speed: float) -> tuple[str, str]:
        """Step, time step, largest speed and rates; time left."""
        first, last = self._samples[0], self._samples[-1]
        report = f"step {last.step:,}  dt {dt:.3g} s  up to {speed:.3g} m/s"
        if last.step == first.step or last.time == first.time:
            return report, ""
        seconds = last.wall - first.wall
        steps = (last.step - first.step) / seconds
        left = (self.end_time - last.time) * seconds / (last.time - first.time)
        report += f"  {short(steps)} steps/s  {short(steps * self.particles)} particle-steps/s"
        return report, f"{duration(left)} left" if left > 0 else "done"


class _Bar:
    """Two lines that are redrawn in place."""

    def __init__(self, width: int):
        from rich.console import Console
        from rich.live import Live

        console = Console(width=width, force_terminal=True)
        self._live = Live(console=console, auto_refresh=False)
        self._live.start()

    def show(self, title: str, share: float, report: str, left: str) -> None:
        from rich.console import Group
        from rich.progress_bar import ProgressBar
        from rich.table import Table
        from rich.text import Text

        line = Table.grid(padding=(0, 1), expand=True)
        line.add_column(no_wrap=True, max_width=30)
        line.add_column(ratio=1)
        for _ in range(2):
            line.add_column(no_wrap=True, justify="right")
        colours = {"style": "bright_black", "complete_style": "cyan", "finished_style": "green"}
        bar = ProgressBar(total=1.0, completed=share, **colours)
        line.add_row(Text(title, "bold"), bar, f"{share:.0%}", left)
        details = Text(report, "dim", no_wrap=True, overflow="ellipsis")
        self._live.update(Group(line, details), refresh=True)

    def close(self) -> None:
        self._live.stop()


def terminal_width() -> int | None:
    """Columns of the terminal that a person looks at, None if there is none.

    Open MPI gives rank 0 a terminal of its own, without a size, even where ``mpirun`` writes to a
    file.  So a terminal without a size counts for nothing; the output of the parent decides.
    """
    if not sys.stdout.isatty():
        return None
    for output in ("/dev/stdout", f"/proc/{os.getppid()}/fd/1"):
        try:
            descriptor = os.open(output, os.O_WRONLY | os.O_NOCTTY)
        except OSError:
            continue
        try:
            columns = os.get_terminal_size(descriptor).columns
        except OSError:
            columns = 0
        os.close(descriptor)
        if columns:
            return columns
    return None


def with_progress(items: Collection[T], doing: str, what: str) -> Iterator[T]:
    """The items one by one; how many are done and the time left go to the standard error.

    On a terminal in place, else in a line every ``PATIENCE`` seconds.  The first one is not taken as typical.
    """
    live = sys.stderr.isatty()
    begun = said = perf_counter()
    for done, item in enumerate(items):
        yield item
        now = perf_counter()
        if done == 0:
            begun = now
        elif now - said > (TICK if live else PATIENCE):
            said = now
            left = (now - begun) / done * (len(items) - done - 1)
            line = f"{doing}: {done + 1} of {len(items)} {what}, {duration(left)} left"
            print(f"\r{line}\x1b[K" if live else line, end="" if live else "\n", file=sys.stderr, flush=True)
    if live:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def short(number: float) -> str:
    """Three digits and a letter: 1234567 -> '1.23 M'."""
    for size, letter in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if number >= 0.9995 * size:
            return f"{number / size:.3g}{letter}"
    return f"{number:.3g}"


def duration(seconds: float) -> str:
    """The two largest units: '45 s', '3 min 20 s', '2 h 05 min', '3 d 04 h'."""
    seconds = round(seconds)
    for size, unit, smaller, name in ((86400, "d", 3600, "h"), (3600, "h", 60, "min")):
        if seconds >= size:
            return f"{seconds // size} {unit} {seconds % size // smaller:02d} {name}"
    return f"{seconds // 60} min {seconds % 60:02d} s" if seconds >= 60 else f"{seconds} s"
