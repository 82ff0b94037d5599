"""psph in a script or a notebook: what ``import psph`` offers, and what the command line calls."""

from psph.api.case import Case, Finding, load
from psph.api.explanation import Explanation
from psph.api.reading import Frame, Results, Table, results
from psph.api.running import Moment, resume, run
from psph.api.studies import StudyResults, study
from psph.case.errors import CaseError
from psph.errors import Foreseen

__all__ = [
    "Case",
    "CaseError",
    "Explanation",
    "Finding",
    "Foreseen",
    "Frame",
    "Moment",
    "Results",
    "StudyResults",
    "Table",
    "load",
    "results",
    "resume",
    "run",
    "study",
]
